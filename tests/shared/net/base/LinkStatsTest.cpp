#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/LinkStats.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr LinkStats::Time kStart{1h};

TEST(LinkStats, SmoothsWithWeightOneEighth) {
  LinkStats stats;
  EXPECT_EQ(stats.smoothed(), 0ms);
  stats.addSample(80ms, kStart);
  EXPECT_EQ(stats.smoothed(), 80ms);
  stats.addSample(160ms, kStart);
  EXPECT_EQ(stats.smoothed(), 90ms);
}

TEST(LinkStats, MinimumExpiresAfterTenSeconds) {
  LinkStats stats;
  stats.addSample(20ms, kStart);
  for (auto time = 1s; time < 10s; time += 1s) stats.addSample(80ms, kStart + time);
  EXPECT_EQ(stats.shortest(), 20ms);
  stats.addSample(80ms, kStart + 10s);
  EXPECT_EQ(stats.shortest(), 80ms);
}

TEST(IdleTimer, CountsSinceTheLastMessage) {
  IdleTimer silence(kStart);
  EXPECT_EQ(silence.idleTime(kStart + 300ms), 300ms);
  silence.onActivity(kStart + 400ms);
  silence.poll(kStart + 500ms);
  EXPECT_EQ(silence.idleTime(kStart + 600ms), 200ms);
}

TEST(IdleTimer, CountsAllSilenceIfPolledOften) {
  IdleTimer silence(kStart);
  for (auto at = kStart; at <= kStart + 10s; at += IdleTimer::kMaxAtOnce) silence.poll(at);
  EXPECT_EQ(silence.idleTime(kStart + 10s), 10s);
}

TEST(IdleTimer, CountsLittleOfTheTimeWithoutPolls) {
  IdleTimer silence(kStart);
  silence.poll(kStart + 1h);
  EXPECT_EQ(silence.idleTime(kStart + 1h), IdleTimer::kMaxAtOnce);
  silence.poll(kStart + 1h + 100ms);
  EXPECT_EQ(silence.idleTime(kStart + 1h + 100ms), IdleTimer::kMaxAtOnce + 100ms);
}

TEST(IdleTimer, MessageAfterAnHourWithoutPollsResetsIdleTime) {
  IdleTimer silence(kStart);
  silence.onActivity(kStart + 1h);
  silence.poll(kStart + 1h + 1ms);
  EXPECT_GE(silence.idleTime(kStart + 1h + 1ms), 0s);
  EXPECT_LE(silence.idleTime(kStart + 1h + 1ms), 1ms);
}

TEST(IdleTimer, ToleratesTimesInTheWrongOrder) {
  IdleTimer silence(kStart);
  silence.poll(kStart + 300ms);
  silence.poll(kStart + 200ms);
  silence.poll(kStart + 700ms);
  EXPECT_EQ(silence.idleTime(kStart + 700ms), 700ms);
}

TEST(PathProbe, IsOpenForASecondAfterEvidence) {
  PathProbe probe(PathProbe::kOpenTime, kStart);
  EXPECT_FALSE(probe.isOpen(kStart));
  probe.addEvidence(kStart);
  EXPECT_TRUE(probe.isOpen(kStart + 999ms));
  EXPECT_FALSE(probe.isDue(kStart + 999ms, true));
  EXPECT_FALSE(probe.isOpen(kStart + 1s));
  EXPECT_TRUE(probe.isDue(kStart + 1s, false));
}

TEST(PathProbe, MayProbeWhileThePathIsStillOpen) {
  PathProbe probe(400ms, kStart - 1min);
  probe.addEvidence(kStart);
  EXPECT_FALSE(probe.isDue(kStart + 399ms, true));
  EXPECT_TRUE(probe.isDue(kStart + 400ms, false));
  probe.probeSent(kStart + 400ms);
  EXPECT_FALSE(probe.isDue(kStart + 499ms, false));
  EXPECT_TRUE(probe.isDue(kStart + 500ms, false));
}

TEST(PathProbe, WithoutEvidenceProbesAreOneSecondApart) {
  PathProbe probe(400ms, kStart - 1min);
  probe.probeSent(kStart);
  EXPECT_FALSE(probe.isDue(kStart + 999ms, false));
  EXPECT_TRUE(probe.isDue(kStart + 250ms, true)) << "there is no other way";
  EXPECT_TRUE(probe.isDue(kStart + 1s, false));
}

}  // namespace
}  // namespace naiad
