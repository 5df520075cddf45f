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
    timing.onDatagramSent(now);
    ++count;
  }
  return count;
}

TEST(UpdateTiming, ProbesEagerlyForTenSecondsAfterADatagram) {
  const Time start{1h};
  UpdateTiming timing;
  timing.onAttached(start - 60s);
  timing.onDatagram(start);
  EXPECT_EQ(probes(timing, start, start + UpdateTiming::kProbeDelay, false), 0);
  EXPECT_NEAR(
      probes(timing, start + UpdateTiming::kProbeDelay, start + UpdateTiming::kDatagramTimeout, false), 6, 1);
  EXPECT_NEAR(probes(timing, start + 1s, start + PathProbe::kEagerTime, false), 36, 1);
  EXPECT_NEAR(probes(timing, start + PathProbe::kEagerTime, start + 20s, false), 10, 1);
}

TEST(UpdateTiming, ProbesEagerlyWhileThereIsNoStream) {
  const Time start{1h};
  UpdateTiming timing;
  timing.onAttached(start - 60s);
  EXPECT_NEAR(probes(timing, start, start + 20s, true), 80, 1);
  EXPECT_NEAR(probes(timing, start + 20s, start + 40s, false), 20, 1);
}

TEST(UpdateTiming, ProbesOftenRightAfterAStreamWasMade) {
  const Time start{1h};
  UpdateTiming timing;
  timing.onAttached(start);
  EXPECT_NEAR(probes(timing, start, start + 1s, false), 10, 1);
  EXPECT_NEAR(probes(timing, start + 1s, start + 11s, false), 10, 1);
}

}  // namespace
}  // namespace naiad::test
