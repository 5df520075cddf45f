#include <gtest/gtest.h>

#include "shared/net/datagram/PrefixBuckets.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = TokenBucket::Time;

constexpr Time kStart{1h};

TEST(TokenBucket, GivesItsBurstAndThenItsRate) {
  const BucketRate rate{.per_second = 10, .burst = 5};
  TokenBucket bucket;
  int taken = 0;
  for (int i = 0; i < 20; ++i) taken += bucket.take(rate, kStart);
  EXPECT_EQ(taken, 5);
  for (int i = 1; i <= 10'000; ++i) taken += bucket.take(rate, kStart + i * 1ms);
  EXPECT_EQ(taken, 105);
  for (int i = 0; i < 20; ++i) taken += bucket.take(rate, kStart + 1h);
  EXPECT_EQ(taken, 110);
}

TEST(TokenBucket, TimeThatGoesBackGivesNothing) {
  const BucketRate rate{.per_second = 1000, .burst = 1};
  TokenBucket bucket;
  EXPECT_TRUE(bucket.take(rate, kStart));
  EXPECT_FALSE(bucket.take(rate, kStart - 1h));
  EXPECT_FALSE(bucket.take(rate, kStart));
  EXPECT_TRUE(bucket.take(rate, kStart + 1ms));
}

TEST(PrefixBuckets, PrefixesDoNotTouchEachOther) {
  PrefixBuckets buckets({.per_second = 1, .burst = 3}, 1);
  for (std::uint64_t prefix = 0; prefix < 100; ++prefix) {
    for (int i = 0; i < 5; ++i) EXPECT_EQ(buckets.take({prefix}, kStart), i < 3);
  }
}

TEST(PrefixBuckets, FloodOfPrefixesOnlyFillsBuckets) {
  PrefixBuckets buckets({.per_second = 1, .burst = 3}, 1);
  SplitMix64 rng(2);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(buckets.take({42}, kStart), i < 3);
  for (int i = 0; i < 100'000; ++i) EXPECT_TRUE(buckets.take({rng.next()}, kStart + 1ms));
  EXPECT_TRUE(buckets.take({42}, kStart + 2ms));
}

TEST(PrefixBuckets, BusyPrefixKeepsItsPlace) {
  PrefixBuckets buckets({.per_second = 1, .burst = 3}, 1);
  SplitMix64 rng(2);
  int taken = 0;
  Time now = kStart;
  for (int i = 0; i < 100'000; ++i, now += 1us) {
    buckets.take({rng.next()}, now);
    if (i % 100 == 0) taken += buckets.take({42}, now);
  }
  EXPECT_EQ(taken, 3);
}

}  // namespace
}  // namespace naiad
