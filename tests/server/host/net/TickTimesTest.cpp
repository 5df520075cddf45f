#include <gtest/gtest.h>

#include "host/net/TickTimes.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TEST(TickTimesTest, QuantilesAreRoundedUpByASixteenthAtMost) {
  TickTimes times;
  EXPECT_EQ(times.quantile(0.99), 0us);
  for (int i = 1; i <= 1000; ++i) times.add(std::chrono::microseconds(37 * i));
  EXPECT_EQ(times.count(), 1000u);
  for (const double share : {0.1, 0.5, 0.9, 0.99}) {
    const double exact = 37 * 1000 * share;
    EXPECT_GE(static_cast<double>(times.quantile(share).count()), exact) << share;
    EXPECT_LE(static_cast<double>(times.quantile(share).count()), exact * 17 / 16 + 38) << share;
  }
  times.reset();
  EXPECT_EQ(times.count(), 0u);
}

TEST(TickTimesTest, ExtremeDurationsHaveABucket) {
  TickTimes times;
  times.add(-5ns);
  times.add(0ns);
  EXPECT_EQ(times.quantile(1), 1us);
  times.add(48h);
  EXPECT_GT(times.quantile(1), 1h);
}

}  // namespace
}  // namespace naiad
