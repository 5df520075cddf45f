#include <gtest/gtest.h>

#include <optional>

#include "host/snapshot/LossDetector.h"
#include "host/snapshot/SentChecksums.h"

namespace naiad {
namespace {

InFlightSnapshots::Snapshot snapshotOf(std::uint32_t number, bool large = false, bool probe = false) {
  return {.number = number, .large = large, .probe = probe, .objects = {}, .names = {}};
}

TEST(LossDetector, TheFirstGapMeansALoss) {
  const LossDetector losses;
  EXPECT_TRUE(losses.isLost(snapshotOf(5), {6, 0}));
  EXPECT_FALSE(losses.isLost(snapshotOf(7), {6, 0})) << "sent later than the newest that arrived";
}

TEST(LossDetector, ALargeSnapshotIsLateRatherThanLost) {
  const LossDetector losses;
  EXPECT_FALSE(losses.isLost(snapshotOf(5, true), {4 + InFlightSnapshots::kMaxSnapshots, 0}));
  EXPECT_TRUE(losses.isLost(snapshotOf(5, true), {5 + InFlightSnapshots::kMaxSnapshots, 0}));
}

TEST(LossDetector, ALateArrivalMakesItPatient) {
  LossDetector losses;
  losses.recordOutcome(snapshotOf(5), true);
  losses.recordLateArrivals({7, 0b01});
  EXPECT_EQ(losses.estimator().reorderThreshold(), 1) << "5 is still missing";
  losses.recordLateArrivals({7, 0b11});
  EXPECT_EQ(losses.estimator().reorderThreshold(), LossEstimator::kReorderThreshold);
  EXPECT_FALSE(losses.isLost(snapshotOf(8), {9, 0}));
  EXPECT_TRUE(losses.isLost(snapshotOf(8), {8 + LossEstimator::kReorderThreshold, 0}));
}

TEST(LossDetector, LostProbeDoesNotCountAsLoss) {
  LossDetector losses;
  losses.recordOutcome(snapshotOf(5, false, true), true);
  EXPECT_EQ(losses.estimator().loss(), 0);
  losses.recordOutcome(snapshotOf(6), true);
  EXPECT_GT(losses.estimator().loss(), 0);
}

TEST(LossEstimator, TwoPercentLossIsRememberedFor250Snapshots) {
  LossEstimator line;
  for (int i = 0; i < 1000; ++i) line.addOutcome(i % 50 == 0);
  EXPECT_NEAR(line.usualLoss(), 0.02, 0.01);
  for (int i = 0; i < 250; ++i) line.addOutcome(false);
  EXPECT_LT(line.loss(), 0.003);
  EXPECT_GT(line.usualLoss(), 0.003);
  for (int i = 0; i < 2000; ++i) line.addOutcome(false);
  EXPECT_LT(line.usualLoss(), 0.003) << "but not for ever";
}

TEST(LossEstimator, TheFirstLossCountsAtOnce) {
  LossEstimator line;
  for (int i = 0; i < 10; ++i) line.addOutcome(false);
  EXPECT_EQ(line.usualLoss(), 0);
  line.addOutcome(true);
  EXPECT_GT(line.usualLoss(), 0.01);
}

TEST(LossEstimator, PatienceFollowsALateArrival) {
  LossEstimator line;
  EXPECT_EQ(line.reorderThreshold(), 1);
  line.addLateArrival();
  EXPECT_EQ(line.reorderThreshold(), LossEstimator::kReorderThreshold);
  for (int i = 0; i < LossEstimator::kReorderMemory - 1; ++i) line.addOutcome(false);
  EXPECT_EQ(line.reorderThreshold(), LossEstimator::kReorderThreshold);
  line.addOutcome(false);
  EXPECT_EQ(line.reorderThreshold(), 1);
}

constexpr std::optional<bool> kUnknown = std::nullopt;

/// Snapshots 1 … 6 with the checksums 10 … 60.
class SentChecksumsTest : public testing::Test {
 protected:
  SentChecksumsTest() {
    for (std::uint32_t number = 1; number <= 6; ++number) sums.recordSent(number, 10 * number);
  }
  static AckWindow allBut(std::uint32_t missing) {
    AckWindow acks;
    for (std::uint32_t number = 1; number <= 6; ++number) {
      if (number != missing) acks.addReceived(number);
    }
    return acks;
  }
  static InFlightSnapshots::Snapshot snapshot(std::uint32_t number, bool empty) {
    return {.number = number, .empty = empty, .objects = {}, .names = {}};
  }
  SentChecksums sums;
};

TEST_F(SentChecksumsTest, ComparesWithTheNewestThatArrived) {
  const AckWindow acks = allBut(0);
  EXPECT_EQ(sums.matches(acks, 60), true);
  EXPECT_EQ(sums.matches(acks, 50), false);
  EXPECT_EQ(sums.matches({7, ~std::uint64_t{0}}, 70), kUnknown) << "not sent";
}

TEST_F(SentChecksumsTest, ALostEmptySnapshotIsNotMissed) {
  sums.recordLost(snapshot(3, true), false, 6);
  EXPECT_EQ(sums.matches(allBut(3), 60), true);
}

TEST_F(SentChecksumsTest, KnowsNothingUntilALossIsRepaired) {
  sums.recordLost(snapshot(3, false), true, 6);
  EXPECT_EQ(sums.matches(allBut(3), 60), kUnknown);
  sums.recordSent(7, 70);
  EXPECT_EQ(sums.matches({7, 0b111011}, 70), kUnknown) << "something is still pending";
  sums.recordComplete(7);
  ASSERT_FALSE((AckWindow{7, 0b110111}.has(3)));
  EXPECT_EQ(sums.matches({7, 0b110111}, 70), true);
  EXPECT_EQ(sums.matches(allBut(3), 60), kUnknown) << "before the repair";
}

TEST_F(SentChecksumsTest, ASnapshotThatWasNotSentIsUnknown) {
  sums.removeNewest(6);
  EXPECT_EQ(sums.matches(allBut(0), 60), kUnknown);
}

TEST_F(SentChecksumsTest, AfterAResetOlderSnapshotsAreUnknown) {
  sums = SentChecksums(7);
  EXPECT_EQ(sums.matches(allBut(0), 60), kUnknown);
  sums.recordSent(7, 70);
  EXPECT_EQ(sums.matches({7, ~std::uint64_t{0}}, 70), true);
}

}  // namespace
}  // namespace naiad
