#include <gtest/gtest.h>

#include "host/snapshot/LossEstimator.h"

namespace naiad::test {
namespace {

TEST(LossEstimator, OneLossInFiftyIsRememberedThroughALuckyWhile) {
  LossEstimator line;
  for (int i = 0; i < 1000; ++i) line.note(i % 50 == 0);
  EXPECT_NEAR(line.usualLoss(), 0.02, 0.01);
  for (int i = 0; i < 250; ++i) line.note(false);
  EXPECT_LT(line.loss(), 0.003);
  EXPECT_GT(line.usualLoss(), 0.003);
  for (int i = 0; i < 2000; ++i) line.note(false);
  EXPECT_LT(line.usualLoss(), 0.003) << "but not for ever";
}

TEST(LossEstimator, TheFirstLossCountsAtOnce) {
  LossEstimator line;
  for (int i = 0; i < 10; ++i) line.note(false);
  EXPECT_EQ(line.usualLoss(), 0);
  line.note(true);
  EXPECT_GT(line.usualLoss(), 0.01);
}

TEST(LossEstimator, ThereIsPatienceOnlyWhereSomethingCameLate) {
  LossEstimator line;
  EXPECT_EQ(line.patience(), 1);
  line.noteLate();
  EXPECT_EQ(line.patience(), LossEstimator::kPatience);
  for (int i = 0; i < LossEstimator::kRemembered - 1; ++i) line.note(false);
  EXPECT_EQ(line.patience(), LossEstimator::kPatience);
  line.note(false);
  EXPECT_EQ(line.patience(), 1);
}

}  // namespace
}  // namespace naiad::test
