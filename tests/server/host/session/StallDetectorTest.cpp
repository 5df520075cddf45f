#include <gtest/gtest.h>

#include "host/session/StreamPair.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kPile = StallDetector::kStallThreshold + 1000;

TEST(StallDetector, StreamIsStuckAfterTenSecondsWithoutProgress) {
  StallDetector detector;
  StallDetector::Time now{1h};
  EXPECT_FALSE(detector.addSample(kPile, now));
  EXPECT_FALSE(detector.addSample(kPile, now + 9999ms));
  EXPECT_TRUE(detector.addSample(kPile, now + 10s));
  EXPECT_TRUE(detector.addSample(kPile + 5000, now + 11s)) << "more bytes do not help";
}

TEST(StallDetector, SlowStreamIsNotStuck) {
  StallDetector detector;
  StallDetector::Time now{1h};
  for (std::size_t left = 900'000; left > 1000; left -= 1000, now += 9s) {
    ASSERT_FALSE(detector.addSample(left, now)) << left;
  }
}

TEST(StallDetector, SmallBacklogIsNeverStuck) {
  StallDetector detector;
  StallDetector::Time now{1h};
  for (int i = 0; i < 100; ++i, now += 1s)
    ASSERT_FALSE(detector.addSample(StallDetector::kStallThreshold, now));
}

TEST(StallDetector, EachNewBacklogRestartsTheTimeout) {
  StallDetector detector;
  StallDetector::Time now{1h};
  detector.addSample(kPile, now);
  detector.addSample(10, now + 9s);
  EXPECT_FALSE(detector.addSample(kPile, now + 10s));
  EXPECT_FALSE(detector.addSample(kPile, now + 19s));
  detector.restart();
  EXPECT_FALSE(detector.addSample(kPile, now + 20s)) << "another stream";
  EXPECT_TRUE(detector.addSample(kPile, now + 30s));
}

}  // namespace
}  // namespace naiad
