#include <gtest/gtest.h>

#include "host/snapshot/LossDetector.h"

namespace naiad::test {
namespace {

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

}  // namespace
}  // namespace naiad::test
