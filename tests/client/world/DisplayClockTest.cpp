#include <gtest/gtest.h>

#include <random>

#include "client/world/DisplayClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = DisplayClock::Time;

const Time kStart = Time{} + 1h;
constexpr auto kTick = std::chrono::microseconds(33333);

class DisplayClockTest : public testing::Test {
 protected:
  DisplayClock clock{kTick};
};

TEST_F(DisplayClockTest, ExtrapolatesTheTickForAtMost250Milliseconds) {
  clock.onSnapshot(100, kStart);
  EXPECT_EQ(clock.displayTick(kStart), 100u);
  EXPECT_EQ(clock.displayTick(kStart + kTick - 1us), 100u);
  EXPECT_EQ(clock.displayTick(kStart + kTick), 101u);
  EXPECT_EQ(clock.displayTick(kStart + 3 * kTick), 103u);
  EXPECT_EQ(clock.displayTick(kStart + 250ms), 107u);
  EXPECT_EQ(clock.displayTick(kStart + 1h), 107u) << "frozen";
}

TEST_F(DisplayClockTest, NeverRunsBackwardsUnderJitter) {
  std::mt19937 random(3);
  std::uint32_t shown = 0;
  Time now = kStart;
  for (std::uint32_t tick = 1; tick < 3000; ++tick) {
    const Time arrival = kStart + tick * kTick + std::chrono::microseconds(random() % 60000);
    now = std::max(now, arrival);
    clock.onSnapshot(tick, now);
    const std::uint32_t next = clock.displayTick(now);
    EXPECT_GE(next, shown);
    EXPECT_GE(next, tick);
    EXPECT_LE(next, tick + 7);
    shown = next;
  }
}

TEST_F(DisplayClockTest, LateSnapshotsDoNotDelayTheClock) {
  // Every other snapshot is 20 ms late. The estimate follows the punctual ones.
  for (std::uint32_t tick = 0; tick < 100; ++tick) {
    const Time due = kStart + tick * kTick;
    const Time arrival = due + (tick % 2 == 1 ? 20ms : 0ms);
    clock.onSnapshot(tick, arrival);
    if (tick > 4 && tick % 2 == 1) {
      EXPECT_EQ(clock.displayTick(due + kTick + 2ms), tick + 1) << "late by 2 ms, not by 20";
    }
  }
}

TEST_F(DisplayClockTest, FollowsAServerThatFallsBehind) {
  clock.onSnapshot(100, kStart);
  // All later snapshots are 150 ms late.
  std::uint32_t tick = 101;
  Time now = kStart;
  for (int i = 0; i < 300; ++i, ++tick) {
    now = kStart + (tick - 100) * kTick + 150ms;
    clock.onSnapshot(tick, now);
  }
  EXPECT_EQ(clock.displayTick(now), tick - 1) << "no longer ahead";
}

TEST_F(DisplayClockTest, RestartsAfterAJump) {
  clock.onSnapshot(100, kStart);
  EXPECT_EQ(clock.displayTick(kStart + 5s), 107u);
  clock.onSnapshot(101, kStart + 5s);
  EXPECT_EQ(clock.displayTick(kStart + 5s), 107u) << "already shown, so not taken back";
  EXPECT_EQ(clock.displayTick(kStart + 5s + 7 * kTick), 108u);
  clock.onSnapshot(5000, kStart + 6s);
  EXPECT_EQ(clock.displayTick(kStart + 6s), 5000u);
}

TEST_F(DisplayClockTest, LateAndRepeatedTicksChangeNothing) {
  clock.onSnapshot(100, kStart);
  clock.onSnapshot(100, kStart + 20ms);
  clock.onSnapshot(90, kStart + 25ms);
  EXPECT_EQ(clock.newestTick(), 100u);
  EXPECT_EQ(clock.displayTick(kStart + kTick), 101u);
}

TEST_F(DisplayClockTest, TicksWrapAround) {
  clock.onSnapshot(0xFFFFFFFF, kStart);
  EXPECT_EQ(clock.displayTick(kStart + 2 * kTick), 1u);
  clock.onSnapshot(2, kStart + 3 * kTick);
  EXPECT_EQ(clock.displayTick(kStart + 3 * kTick), 2u);
}

TEST_F(DisplayClockTest, NextTickIsInTheFuture) {
  EXPECT_GT(clock.nextTick(kStart), kStart);
  clock.onSnapshot(100, kStart);
  EXPECT_EQ(clock.nextTick(kStart), kStart + kTick);
  EXPECT_EQ(clock.nextTick(kStart + kTick), kStart + 2 * kTick);
  EXPECT_GT(clock.nextTick(kStart + 1h), kStart + 1h);
}

}  // namespace
}  // namespace naiad
