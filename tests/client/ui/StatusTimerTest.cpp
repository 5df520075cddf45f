#include <gtest/gtest.h>

#include "client/ui/FrameComposer.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

TEST(StatusTimer, ShowsForAMomentAfterJoining) {
  StatusTimer timer;
  StatusTimer::Time now{1h};
  EXPECT_FALSE(timer.isShown(now));
  timer.update(3, 40ms, now);
  EXPECT_TRUE(timer.isShown(now));
  now += StatusTimer::kShown;
  timer.update(3, 40ms, now);
  EXPECT_FALSE(timer.isShown(now));
  timer.update(4, 40ms, now);
  EXPECT_TRUE(timer.isShown(now)) << "as another player, after the server was lost";
}

TEST(StatusTimer, ShowsForAMomentWhenTheConnectionBecomesBad) {
  StatusTimer timer;
  StatusTimer::Time now{1h};
  timer.update(3, 40ms, now);
  now += StatusTimer::kShown;
  int shown = 0;
  // Bad all the time, with slight improvements in between.
  for (int i = 0; i < 600; ++i, now += 100ms) {
    timer.update(3, i % 2 == 0 ? StatusTimer::kBad : StatusTimer::kBad - 20ms, now);
    shown += timer.isShown(now) ? 1 : 0;
  }
  EXPECT_EQ(shown, StatusTimer::kShown / 100ms) << "once: it must not stay over the game";
  timer.update(3, 40ms, now);
  timer.update(3, StatusTimer::kBad, now);
  EXPECT_TRUE(timer.isShown(now));
}

}  // namespace
}  // namespace naiad
