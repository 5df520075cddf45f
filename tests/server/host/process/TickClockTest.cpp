#include <gtest/gtest.h>

#include "host/process/TickClock.h"
#include "host/process/Watchdog.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TickClock::Clock::time_point at(std::chrono::nanoseconds since_start) {
  return TickClock::Clock::time_point(10s) + since_start;
}

TEST(TickClock, ThirtyTicksTakeExactlyASecond) {
  TickClock clock(at(0ns));
  EXPECT_EQ(clock.deadline(), at(0ns)) << "the first tick is due at once";
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(clock.beginTick(clock.deadline()));
  EXPECT_EQ(clock.deadline(), at(1s));
  for (int i = 0; i < 30 * 3600; ++i) clock.beginTick(clock.deadline());
  EXPECT_EQ(clock.deadline(), at(1h + 1s));
}

TEST(TickClock, SlightDelayKeepsTheSchedule) {
  TickClock clock(at(0ns));
  EXPECT_FALSE(clock.beginTick(at(33ms)));
  EXPECT_EQ(clock.deadline(), at(33'333'333ns));
  EXPECT_FALSE(clock.beginTick(at(60ms)));
  EXPECT_EQ(clock.deadline(), at(66'666'666ns));
}

TEST(TickClock, LongDelayRebasesTheSchedule) {
  TickClock clock(at(0ns));
  clock.beginTick(at(0ns));
  EXPECT_TRUE(clock.beginTick(at(2s)));
  EXPECT_EQ(clock.deadline(), at(2s + 33'333'333ns)) << "lost time is not made up";
  EXPECT_FALSE(clock.beginTick(clock.deadline()));
}

TEST(TickClock, LengthIsSetInMicrosecondsOrDefaultsAtZero) {
  TickClock clock(at(0ns), TickLength::fromMicros(10'000));
  for (int i = 0; i < 7; ++i) clock.beginTick(clock.deadline());
  EXPECT_EQ(clock.deadline(), at(70ms));
  EXPECT_EQ(TickLength::fromMicros(0).times(30), 1s);
}

using Step = HangDetector::Step;

class HangDetectorTest : public testing::Test {
 protected:
  /// `in_tick`: how long tick 7 has been running.
  Step check(std::chrono::milliseconds in_tick, int stops = 0) {
    return watch.check(7, now - in_tick, stops, now);
  }
  HangDetector watch;
  HangDetector::Time now{1h};
};

TEST_F(HangDetectorTest, ReportsATickThatHangsOnce) {
  EXPECT_EQ(check(900ms), Step::kNothing);
  EXPECT_EQ(check(1000ms), Step::kReport);
  EXPECT_EQ(check(9000ms), Step::kNothing);
  EXPECT_EQ(watch.check(8, now - 6s, 0, now), Step::kReport) << "another tick";
  EXPECT_EQ(watch.check(std::nullopt, {}, 0, now), Step::kNothing);
}

TEST_F(HangDetectorTest, SignalDuringAHungTickEndsTheServer) {
  EXPECT_EQ(check(2s), Step::kReport);
  EXPECT_EQ(check(6s, 1), Step::kNothing) << "the tick may finish just now";
  now += 900ms;
  EXPECT_EQ(check(6900ms, 1), Step::kNothing);
  now += 100ms;
  EXPECT_EQ(check(7s, 1), Step::kExitHung);
}

TEST_F(HangDetectorTest, ASlowTickMayFinishAfterASignal) {
  EXPECT_EQ(check(10ms, 1), Step::kNothing);
  now += 2900ms;
  EXPECT_EQ(check(2910ms, 1), Step::kReport) << "it is said, and may finish all the same";
  EXPECT_EQ(watch.check(std::nullopt, {}, 1, now + 10s), Step::kNothing) << "the host ends by itself";
  EXPECT_EQ(check(3s, 1), Step::kExitHung);
}

TEST_F(HangDetectorTest, ASecondSignalEndsAtOnce) {
  EXPECT_EQ(check(10ms, 2), Step::kExitNow);
  EXPECT_EQ(watch.check(std::nullopt, {}, 2, now), Step::kExitNow);
}

}  // namespace
}  // namespace naiad
