#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "shared/replica/Acks.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

TEST(Acks, KnowNothingAtFirst) {
  const AckWindow acks;
  EXPECT_FALSE(acks.has(0));
  EXPECT_FALSE(acks.has(1));
  EXPECT_FALSE(acks.has(0xFFFFFFFF));
}

TEST(Acks, MatchASetOfTheLast65Numbers) {
  SplitMix64 rng(4);
  for (int run = 0; run < 50; ++run) {
    AckWindow acks;
    std::set<std::uint32_t> heard;
    std::uint32_t newest = 0;
    std::uint32_t next = 1;
    for (int i = 0; i < 400; ++i) {
      next += 1 + static_cast<std::uint32_t>(rng.below(5) == 0 ? rng.below(80) : rng.below(2));
      const auto late = static_cast<std::uint32_t>(rng.below(90));
      const std::uint32_t number = next > late ? next - late : next;
      acks.addReceived(number);
      if (number >= newest || newest - number <= 64) heard.insert(number);
      newest = std::max(newest, number);
      ASSERT_EQ(acks.newest, newest);
      for (std::uint32_t back = 0; back < 70 && back < newest; ++back) {
        const bool expected = back <= 64 && heard.count(newest - back) != 0;
        ASSERT_EQ(acks.has(newest - back), expected) << newest << " - " << back;
      }
      ASSERT_FALSE(acks.has(newest + 1));
    }
  }
}

TEST(Acks, SurviveTheNumberWrap) {
  AckWindow acks;
  acks.newest = 0xFFFFFFFE;
  acks.mask = 1;
  acks.addReceived(0xFFFFFFFF);
  acks.addReceived(2);  // snapshot number 0 is never used
  EXPECT_EQ(acks.newest, 2u);
  EXPECT_TRUE(acks.has(0xFFFFFFFF));
  EXPECT_TRUE(acks.has(0xFFFFFFFE));
  EXPECT_TRUE(acks.has(0xFFFFFFFD));
  EXPECT_FALSE(acks.has(1));
  EXPECT_TRUE(isNewer(2, 0xFFFFFFFF));
  EXPECT_FALSE(isNewer(0xFFFFFFFF, 2));
}

TEST(Acks, FirstNumberMayBeAnything) {
  for (const std::uint32_t first : {1u, 65u, 0x80000000u, 0xFFFFFFFFu}) {
    AckWindow acks;
    acks.addReceived(first);
    EXPECT_EQ(acks.newest, first);
    EXPECT_EQ(acks.mask, 0u) << "nothing before it came";
    EXPECT_TRUE(acks.has(first));
    acks.addReceived(first - 2);
    EXPECT_EQ(acks.newest, first);
    EXPECT_EQ(acks.mask, 2u);
  }
}

}  // namespace
}  // namespace naiad
