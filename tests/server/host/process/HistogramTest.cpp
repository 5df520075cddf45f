#include <gtest/gtest.h>

#include <array>

#include "host/process/StageClock.h"

namespace naiad {
namespace {

constexpr std::array<double, 3> kBounds{0.001, 0.01, 0.1};

TEST(Histogram, ValueFallsIntoTheSmallestFittingBucket) {
  Histogram histogram(kBounds);
  for (const double value : {-1.0, 0.0, 0.001, 0.0011, 0.01, 0.05, 0.1, 0.11, 1e9}) histogram.add(value);
  EXPECT_EQ(histogram.count(0), 3u);  // a value equal to a bound is below it
  EXPECT_EQ(histogram.count(1), 2u);
  EXPECT_EQ(histogram.count(2), 2u);
  EXPECT_EQ(histogram.count(3), 2u);  // above the last bound
}

TEST(Histogram, BoundsBeyondTheMaximumAreDropped) {
  std::array<double, Histogram::kMaxBounds + 4> many{};
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  Histogram histogram(many);
  histogram.add(1e6);
  EXPECT_EQ(histogram.bounds().size(), Histogram::kMaxBounds);
  EXPECT_EQ(histogram.count(Histogram::kMaxBounds), 1u);
}

}  // namespace
}  // namespace naiad
