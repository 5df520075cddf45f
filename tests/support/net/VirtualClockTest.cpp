#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/support/net/VirtualClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TEST(VirtualClock, RunsActionsInTimeThenSchedulingOrder) {
  VirtualClock clock;
  std::string order;
  clock.schedule(2ms, [&] { order += 'c'; });
  clock.schedule(1ms, [&] { order += 'a'; });
  clock.schedule(2ms, [&] { order += 'd'; });
  clock.schedule(1ms, [&] { order += 'b'; });
  clock.advanceBy(5ms);
  EXPECT_EQ(order, "abcd");
  EXPECT_EQ(clock.now(), 5ms);
}

TEST(VirtualClock, DoesNotRunLaterActions) {
  VirtualClock clock;
  int runs = 0;
  clock.schedule(2ms, [&] { ++runs; });
  clock.advanceTo(1999us);
  EXPECT_EQ(runs, 0);
  EXPECT_EQ(clock.nextDue(), 2ms);
  clock.advanceTo(2ms);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(clock.nextDue(), std::nullopt);
}

TEST(VirtualClock, RefusesBackwardAndNestedAdvances) {
  VirtualClock clock;
  clock.advanceTo(5ms);
  EXPECT_THROW(clock.advanceTo(4ms), std::logic_error);
  clock.schedule(6ms, [&] { clock.advanceBy(1ms); });
  EXPECT_THROW(clock.advanceTo(7ms), std::logic_error);
  EXPECT_NO_THROW(clock.advanceTo(8ms));
}

}  // namespace
}  // namespace naiad
