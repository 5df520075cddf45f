#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/LinkStats.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr LinkStats::Time kStart{1h};

TEST(LinkStats, SmoothsWithWeightOneEighth) {
  LinkStats stats;
  EXPECT_EQ(stats.smoothed(), 0ms);
  stats.addSample(80ms, kStart);
  EXPECT_EQ(stats.smoothed(), 80ms);
  stats.addSample(160ms, kStart);
  EXPECT_EQ(stats.smoothed(), 90ms);
}

TEST(LinkStats, MinimumExpiresAfterTenSeconds) {
  LinkStats stats;
  stats.addSample(20ms, kStart);
  for (auto time = 1s; time < 10s; time += 1s) stats.addSample(80ms, kStart + time);
  EXPECT_EQ(stats.shortest(), 20ms);
  stats.addSample(80ms, kStart + 10s);
  EXPECT_EQ(stats.shortest(), 80ms);
}

}  // namespace
}  // namespace naiad
