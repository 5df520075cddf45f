#include <gtest/gtest.h>

#include "shared/net/base/LinkStats.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

const IdleTimer::Time kBegin{1000s};

TEST(IdleTimer, CountsSinceTheLastMessage) {
  IdleTimer silence(kBegin);
  EXPECT_EQ(silence.idleTime(kBegin + 300ms), 300ms);
  silence.onActivity(kBegin + 400ms);
  silence.poll(kBegin + 500ms);
  EXPECT_EQ(silence.idleTime(kBegin + 600ms), 200ms);
}

TEST(IdleTimer, CountsAllSilenceIfPolledOften) {
  IdleTimer silence(kBegin);
  for (auto at = kBegin; at <= kBegin + 10s; at += IdleTimer::kMaxAtOnce) silence.poll(at);
  EXPECT_EQ(silence.idleTime(kBegin + 10s), 10s);
}

TEST(IdleTimer, CountsLittleOfTheTimeWithoutPolls) {
  IdleTimer silence(kBegin);
  silence.poll(kBegin + 1h);
  EXPECT_EQ(silence.idleTime(kBegin + 1h), IdleTimer::kMaxAtOnce);
  silence.poll(kBegin + 1h + 100ms);
  EXPECT_EQ(silence.idleTime(kBegin + 1h + 100ms), IdleTimer::kMaxAtOnce + 100ms);
}

TEST(IdleTimer, MessageAfterAnHourWithoutPollsResetsIdleTime) {
  IdleTimer silence(kBegin);
  silence.onActivity(kBegin + 1h);
  silence.poll(kBegin + 1h + 1ms);
  EXPECT_GE(silence.idleTime(kBegin + 1h + 1ms), 0s);
  EXPECT_LE(silence.idleTime(kBegin + 1h + 1ms), 1ms);
}

TEST(IdleTimer, ToleratesTimesInTheWrongOrder) {
  IdleTimer silence(kBegin);
  silence.poll(kBegin + 300ms);
  silence.poll(kBegin + 200ms);
  silence.poll(kBegin + 700ms);
  EXPECT_EQ(silence.idleTime(kBegin + 700ms), 700ms);
}

}  // namespace
}  // namespace naiad
