#include <gtest/gtest.h>

#include "host/session/StallDetector.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kPile = StallDetector::kMuch + 1000;

TEST(StallDetector, WhoTakesNothingForTenSecondsHasStuck) {
  StallDetector drain;
  StallDetector::Time now{1h};
  EXPECT_FALSE(drain.note(kPile, now));
  EXPECT_FALSE(drain.note(kPile, now + 9999ms));
  EXPECT_TRUE(drain.note(kPile, now + 10s));
  EXPECT_TRUE(drain.note(kPile + 5000, now + 11s)) << "more on top is no way out";
}

TEST(StallDetector, WhoIsSlowHasNot) {
  StallDetector drain;
  StallDetector::Time now{1h};
  for (std::size_t left = 900'000; left > 1000; left -= 1000, now += 9s) {
    ASSERT_FALSE(drain.note(left, now)) << left;
  }
}

TEST(StallDetector, LittleMayLieForEver) {
  StallDetector drain;
  StallDetector::Time now{1h};
  for (int i = 0; i < 100; ++i, now += 1s) ASSERT_FALSE(drain.note(StallDetector::kMuch, now));
}

TEST(StallDetector, TheTimeBeginsAnewWithEachPile) {
  StallDetector drain;
  StallDetector::Time now{1h};
  drain.note(kPile, now);
  drain.note(10, now + 9s);
  EXPECT_FALSE(drain.note(kPile, now + 10s));
  EXPECT_FALSE(drain.note(kPile, now + 19s));
  drain.restart();
  EXPECT_FALSE(drain.note(kPile, now + 20s)) << "another stream";
  EXPECT_TRUE(drain.note(kPile, now + 30s));
}

}  // namespace
}  // namespace naiad
