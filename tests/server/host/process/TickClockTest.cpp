#include <gtest/gtest.h>

#include "host/process/TickClock.h"

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

}  // namespace
}  // namespace naiad
