#include <gtest/gtest.h>

#include "client/session/UpdateTiming.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Time = UpdateTiming::Time;

/// Counts the probes sent from `from` to `to` while nothing arrives.
int probes(UpdateTiming& timing, Time from, Time to, bool only) {
  int count = 0;
  for (Time now = from; now < to; now += 10ms) {
    if (!timing.isProbeDue(now, only)) continue;
    timing.noteDatagramSent(now);
    ++count;
  }
  return count;
}

TEST(UpdateTiming, ProbesEagerlyForAWhileAfterDatagramsCame) {
  const Time start{1h};
  UpdateTiming timing;
  timing.noteAttached(start - 60s);
  timing.noteDatagram(start);
  EXPECT_EQ(probes(timing, start, start + UpdateTiming::kQuiet, false), 0);
  EXPECT_NEAR(probes(timing, start + UpdateTiming::kQuiet, start + UpdateTiming::kPassing, false), 6, 1);
  EXPECT_NEAR(probes(timing, start + 1s, start + PathProbe::kEagerFor, false), 36, 1);
  EXPECT_NEAR(probes(timing, start + PathProbe::kEagerFor, start + 20s, false), 10, 1);
}

TEST(UpdateTiming, ProbesEagerlyWhileThereIsNoStream) {
  const Time start{1h};
  UpdateTiming timing;
  timing.noteAttached(start - 60s);
  EXPECT_NEAR(probes(timing, start, start + 20s, true), 80, 1);
  EXPECT_NEAR(probes(timing, start + 20s, start + 40s, false), 20, 1);
}

TEST(UpdateTiming, ProbesOftenRightAfterAStreamWasMade) {
  const Time start{1h};
  UpdateTiming timing;
  timing.noteAttached(start);
  EXPECT_NEAR(probes(timing, start, start + 1s, false), 10, 1);
  EXPECT_NEAR(probes(timing, start + 1s, start + 11s, false), 10, 1);
}

}  // namespace
}  // namespace naiad::test
