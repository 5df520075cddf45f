#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/TokenBucket.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = TokenBucket::Time;

constexpr Time kFull{1h};

TEST(TokenBucket, GivesItsBurstAndThenItsRate) {
  const BucketRate rate{.per_second = 10, .burst = 5};
  TokenBucket bucket;
  int taken = 0;
  for (int i = 0; i < 20; ++i) taken += bucket.tryConsume(rate, kFull);
  EXPECT_EQ(taken, 5);
  for (int i = 1; i <= 10'000; ++i) taken += bucket.tryConsume(rate, kFull + i * 1ms);
  EXPECT_EQ(taken, 105);
  for (int i = 0; i < 20; ++i) taken += bucket.tryConsume(rate, kFull + 1h);
  EXPECT_EQ(taken, 110);
}

TEST(TokenBucket, BackwardTimeGivesNoTokens) {
  const BucketRate rate{.per_second = 1000, .burst = 1};
  TokenBucket bucket;
  EXPECT_TRUE(bucket.tryConsume(rate, kFull));
  EXPECT_FALSE(bucket.tryConsume(rate, kFull - 1h));
  EXPECT_FALSE(bucket.tryConsume(rate, kFull));
  EXPECT_TRUE(bucket.tryConsume(rate, kFull + 1ms));
}

TEST(TokenBucket, ForcedTokensAddDebtOfAtMostABurst) {
  const BucketRate rate{.per_second = 1, .burst = 3};
  TokenBucket bucket;
  for (int i = 0; i < 100; ++i) bucket.forceConsume(rate, kFull);
  EXPECT_FALSE(bucket.tryConsume(rate, kFull + 3s));
  EXPECT_TRUE(bucket.tryConsume(rate, kFull + 4s));
}

}  // namespace
}  // namespace naiad
