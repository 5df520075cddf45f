#include <gtest/gtest.h>

#include "host/snapshot/LossDetector.h"

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

}  // namespace
}  // namespace naiad
