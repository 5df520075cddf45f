#include <gtest/gtest.h>

#include "shared/net/base/LinkStats.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

const IdleTimer::Time kBegin{1000s};

TEST(IdleTimer, CountsSinceTheLastMessage) {
  IdleTimer silence(kBegin);
  EXPECT_EQ(silence.at(kBegin + 300ms), 300ms);
  silence.heard(kBegin + 400ms);
  silence.listen(kBegin + 500ms);
  EXPECT_EQ(silence.at(kBegin + 600ms), 200ms);
}

TEST(IdleTimer, CountsAllSilenceIfPolledOften) {
  IdleTimer silence(kBegin);
  for (auto at = kBegin; at <= kBegin + 10s; at += IdleTimer::kMaxAtOnce) silence.listen(at);
  EXPECT_EQ(silence.at(kBegin + 10s), 10s);
}

TEST(IdleTimer, CountsLittleOfTheTimeWithoutPolls) {
  IdleTimer silence(kBegin);
  silence.listen(kBegin + 1h);
  EXPECT_EQ(silence.at(kBegin + 1h), IdleTimer::kMaxAtOnce);
  silence.listen(kBegin + 1h + 100ms);
  EXPECT_EQ(silence.at(kBegin + 1h + 100ms), IdleTimer::kMaxAtOnce + 100ms);
}

TEST(IdleTimer, RestartsWithTheFirstReadAfterAnAbsence) {
  IdleTimer silence(kBegin);
  silence.heard(kBegin + 1h);
  silence.listen(kBegin + 1h + 1ms);
  EXPECT_GE(silence.at(kBegin + 1h + 1ms), 0s);
  EXPECT_LE(silence.at(kBegin + 1h + 1ms), 1ms);
}

TEST(IdleTimer, ToleratesTimesInTheWrongOrder) {
  IdleTimer silence(kBegin);
  silence.listen(kBegin + 300ms);
  silence.listen(kBegin + 200ms);
  silence.listen(kBegin + 700ms);
  EXPECT_EQ(silence.at(kBegin + 700ms), 700ms);
}

}  // namespace
}  // namespace naiad
