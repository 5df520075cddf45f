#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "physics/body/BodyContacts.h"
#include "shared/values/SplitMix64.h"

namespace naiad::physics {
namespace {

BodyContact contactOf(df::ObjectKey first, df::ObjectKey second, bool is_begin) {
  return {0, first, second, first.slot, second.slot, 0, is_begin, BodySolver::kRigid};
}

using Pair = std::pair<df::ObjectKey, df::ObjectKey>;

// Contacts begin and end at random, bodies are deleted, and slots are reused. The reference is a plain list.
TEST(BodyTouching, MatchesAPlainListOfContacts) {
  constexpr std::uint32_t kSlots = 12;
  SplitMix64 random(9);
  const auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random.next() % limit); };
  BodyContacts contacts;
  std::vector<Pair> plain;
  std::uint32_t generation[kSlots] = {};
  std::fill(std::begin(generation), std::end(generation), 1);
  int touched = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    contacts.beginTick();
    const std::uint32_t a = below(kSlots), b = below(kSlots);
    const Pair pair = {{std::min(a, b), generation[std::min(a, b)]},
                       {std::max(a, b), generation[std::max(a, b)]}};
    const auto at = std::find(plain.begin(), plain.end(), pair);
    const bool is_begin = below(3) > 0;
    if (a != b) {
      contacts.add(contactOf(pair.first, pair.second, is_begin));
      if (!is_begin && at != plain.end()) plain.erase(at);
      if (is_begin && at == plain.end()) {
        std::erase_if(plain, [&](const Pair& old) {
          return old.first.slot == pair.first.slot && old.second.slot == pair.second.slot;
        });
        plain.push_back(pair);
      }
    }
    if (below(10) == 0) {  // delete a body and reuse its slot; its contacts may end later
      const std::uint32_t slot = below(kSlots);
      const df::ObjectKey gone = {slot, generation[slot]};
      if (below(2) == 0) {
        contacts.expire(gone);
        std::erase_if(plain, [&](const Pair& old) { return old.first == gone || old.second == gone; });
      }
      ++generation[slot];
    }
    contacts.finishTick();
    for (std::uint32_t slot = 0; slot < kSlots; ++slot) {
      for (std::uint32_t g = generation[slot] > 3 ? generation[slot] - 3 : 1; g <= generation[slot]; ++g) {
        const df::ObjectKey key = {slot, g};
        const bool is_touching = std::any_of(
            plain.begin(), plain.end(), [&](const Pair& p) { return p.first == key || p.second == key; });
        ASSERT_EQ(contacts.isTouching(key), is_touching) << tick << ' ' << slot << ' ' << g;
        touched += is_touching ? 1 : 0;
      }
    }
    ASSERT_EQ(contacts.isEmpty(), plain.empty());
  }
  EXPECT_GT(touched, 1000);
}

// A body that bounces fast may change its solver in each tick.
TEST(BodyTouching, RepeatedHandOversEndAContact) {
  BodyContacts contacts;
  const df::ObjectKey first = {0, 1}, second = {1, 1};
  contacts.add(contactOf(first, second, true));
  contacts.finishTick();
  std::size_t ends = 0;
  for (int tick = 0; tick < 5; ++tick) {
    contacts.beginTick();
    contacts.handOver(first);
    ends += contacts.finishTick().size();
  }
  EXPECT_EQ(ends, 1u);
  EXPECT_FALSE(contacts.isTouching(second));
}

}  // namespace
}  // namespace naiad::physics
