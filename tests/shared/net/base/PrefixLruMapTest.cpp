#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/PrefixLruMap.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr TokenBucket::Time kFirst{1h};
constexpr BucketRate kRate{.per_second = 1, .burst = 3};

/// Returns a different /64 for each number.
AddressPrefix prefix(std::uint64_t number) {
  AddressPrefix::Bytes bytes{};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (56 - 8 * i));
  return AddressPrefix(bytes);
}

TEST(PrefixLruMap, PrefixFloodKeepsTheTableBounded) {
  PrefixLruMap<TokenBucket> buckets(4096);
  SplitMix64 rng(2);
  const auto tryConsume = [&](std::uint64_t number, TokenBucket::Time now) {
    return buckets.use(prefix(number)).tryConsume(kRate, now);
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(tryConsume(42, kFirst), i < 3);
  for (int i = 0; i < 100'000; ++i) EXPECT_TRUE(tryConsume(rng.next(), kFirst + 1ms));
  EXPECT_TRUE(tryConsume(42, kFirst + 2ms));
  EXPECT_EQ(buckets.size(), 4096u);
}

TEST(PrefixLruMap, EvictsTheLeastRecentlyUsed) {
  PrefixLruMap<int> table(2);
  table.use(prefix(1)) = 10;
  table.use(prefix(2)) = 20;
  EXPECT_EQ(table.use(prefix(1)), 10);
  table.use(prefix(3)) = 30;
  EXPECT_EQ(table.find(prefix(2)), nullptr);
  EXPECT_NE(table.find(prefix(1)), nullptr);
  EXPECT_EQ(*table.find(prefix(3)), 30);
}

TEST(PrefixLruMap, ErasedPrefixesFreeTheirSlot) {
  PrefixLruMap<int> table(2);
  table.use(prefix(1)) = 10;
  table.use(prefix(2)) = 20;
  table.erase(prefix(1));
  table.erase(prefix(9));
  EXPECT_EQ(table.size(), 1u);
  EXPECT_EQ(table.use(prefix(3)), 0);
  EXPECT_EQ(*table.find(prefix(2)), 20);
}

}  // namespace
}  // namespace naiad
