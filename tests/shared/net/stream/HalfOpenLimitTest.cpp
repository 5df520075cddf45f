#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "shared/net/stream/HalfOpenLimit.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using Id = HalfOpenLimit::Id;
using Kind = HalfOpenLimit::Result::Kind;

AddressPrefix of(const std::string& text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

/// Returns a /64 in a /56 of its own, for a customer who has a /48.
AddressPrefix customersNetwork(int customer, int network) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "2001:db8:%x:%x00::1", customer, network);
  return of(text.data());
}

class HalfOpenLimitTest : public testing::Test {
 protected:
  /// Admits a connection like a listener. Returns the id of the connection that was ended for it; 0: none.
  Id come(const AddressPrefix& prefix) {
    auto verdict = limit.check(prefix);
    const Id ended = verdict.kind == Kind::kEvictFirst ? verdict.id : 0;
    if (ended != 0) limit.release(ended);
    verdict = limit.check(prefix);
    EXPECT_EQ(verdict.kind, Kind::kFits);
    limit.admit(++newest, prefix);
    return ended;
  }
  /// Admits a connection whose ClientHello is already complete. Returns false if it is refused.
  bool comeWithHello(const AddressPrefix& prefix) {
    const auto verdict = limit.check(prefix);
    if (verdict.kind == Kind::kEvictFirst) limit.release(verdict.id);
    if (verdict.kind == Kind::kFull || verdict.kind == Kind::kFullForPrefix) return false;
    limit.admit(++newest, prefix);
    EXPECT_TRUE(limit.onHello(newest)) << "judged the same when it came";
    return true;
  }
  /// Fills all slots with connections in their ClientHellos. Completes these in order, releasing refused
  /// ones.
  void beginAndFinishTogether(const std::vector<AddressPrefix>& prefixes) {
    for (std::size_t i = 0; limit.count() < 256; ++i) come(prefixes[i % prefixes.size()]);
    for (Id id = 1; id <= newest; ++id) {
      if (!limit.onHello(id)) limit.release(id);
    }
  }
  /// Admits `times` connections from each of `prefixes` in turn. Returns how many succeed.
  int flood(const std::vector<AddressPrefix>& prefixes, int times) {
    int admitted = 0;
    for (int i = 0; i < times; ++i) {
      for (const AddressPrefix& prefix : prefixes) admitted += comeWithHello(prefix) ? 1 : 0;
    }
    return admitted;
  }

  /// Expects that `count` networks without a connection can each complete a ClientHello.
  void expectRoomFor(int count) {
    for (int i = 0; i < count; ++i) EXPECT_TRUE(comeWithHello(of("192.0." + std::to_string(i) + ".1")));
  }

  HalfOpenLimit limit{{}};  // 256 in all, 64 per prefix
  Id newest = 0;
};

TEST_F(HalfOpenLimitTest, HelloFloodOfFourCustomersLeavesFreeSlots) {
  std::vector<AddressPrefix> many;
  for (int customer = 0; customer < 4; ++customer) {
    for (int network = 0; network < 200; ++network) many.push_back(customersNetwork(customer, network));
  }
  flood(many, 10);
  EXPECT_LE(limit.count(), 240u) << "one customer after the other: the first has half, the next a quarter, …";
  expectRoomFor(10);
}

TEST_F(HalfOpenLimitTest, NineNetworksInTurnTakeAllSlots) {
  int networks = 0;
  for (; limit.check(of("203.0.113.1")).kind == Kind::kFits; ++networks) {
    std::vector<AddressPrefix> network;
    for (int host = 0; host < 200; ++host)
      network.push_back(of("198.51." + std::to_string(networks) + "." + std::to_string(host)));
    flood(network, 10);
  }
  EXPECT_EQ(networks, 9) << "as threats.md says";
}

TEST_F(HalfOpenLimitTest, SimultaneousHellosOfOneNetworkLeaveFreeSlots) {
  beginAndFinishTogether({of("198.51.100.1"), of("198.51.100.2"), of("198.51.100.3"), of("198.51.100.4")});
  EXPECT_EQ(limit.count(), 128u) << "one network has half of the places";
  EXPECT_FALSE(comeWithHello(of("198.51.100.5")));
  expectRoomFor(40);
}

TEST_F(HalfOpenLimitTest, IsCrowdedAboveHalfOfTheLimit) {
  for (int i = 0; i < 128; ++i) come(of("192.0." + std::to_string(i) + ".1"));
  EXPECT_FALSE(limit.isCrowded());
  come(of("203.0.113.1"));
  EXPECT_TRUE(limit.isCrowded());
  limit.release(3);
  EXPECT_FALSE(limit.isCrowded());
}

TEST_F(HalfOpenLimitTest, OnlyAdmittedConnectionsCanBeReleased) {
  come(of("192.0.2.1"));
  limit.release(1);
  EXPECT_EQ(limit.count(), 0u);
  EXPECT_THROW(limit.release(1), std::out_of_range);
  EXPECT_THROW((void)limit.onHello(1), std::out_of_range);
  EXPECT_FALSE(limit.isSilent(1));
}

/// The rules of HalfOpenLimit, computed in the simplest way: counts all connections again for each question.
class NaiveLimit {
 public:
  struct Entry {
    Id id;
    AddressPrefix prefix;
    bool greeted;
  };

  explicit NaiveLimit(HalfOpenLimit::Limits limits) : m_limits(limits) {}

  HalfOpenLimit::Result check(const AddressPrefix& prefix) const {
    const auto all = [](const Entry&) { return true; };
    const std::size_t greeted = count(true, all);
    if (greeted >= m_limits.total) return {Kind::kFull};
    const auto same = [&](const Entry& e) { return e.prefix == prefix; };
    if (hasItsShare(prefix)) return {Kind::kFullForPrefix};
    if (count(true, same) + count(false, same) >= m_limits.per_prefix) {
      for (const Entry& e : entries) {
        if (!e.greeted && same(e)) return {Kind::kEvictFirst, e.id};
      }
      return {Kind::kFullForPrefix};
    }
    if (entries.size() < m_limits.total) return {Kind::kFits};
    HalfOpenLimit::Result worst{Kind::kEvictFirst};
    std::array<std::size_t, 3> most{};
    for (const Entry& e : entries) {
      if (e.greeted) continue;
      const std::array crowd{
          count(false, [&](const Entry& o) { return o.prefix.widest() == e.prefix.widest(); }),
          count(false, [&](const Entry& o) { return o.prefix.wide() == e.prefix.wide(); }),
          count(false, [&](const Entry& o) { return o.prefix == e.prefix; })};
      if (crowd > most) {
        most = crowd;
        worst.id = e.id;
      }
    }
    return worst;
  }

  bool hasItsShare(const AddressPrefix& prefix) const {
    const std::size_t free = m_limits.total - count(true, [](const Entry&) { return true; });
    return count(true, [&](const Entry& e) { return e.prefix.widest() == prefix.widest(); }) >= free;
  }

  std::vector<Entry> entries;

 private:
  template <class Of>
  std::size_t count(bool greeted, Of of) const {
    return static_cast<std::size_t>(std::count_if(
        entries.begin(), entries.end(), [&](const Entry& e) { return e.greeted == greeted && of(e); }));
  }

  HalfOpenLimit::Limits m_limits;
};

AddressPrefix randomPrefix(SplitMix64& random) {
  const auto few = [&] { return std::to_string(random.below(3)); };
  if (random.below(2) == 0) return of("192.0." + few() + "." + few());
  return of("2001:db8:" + few() + ":" + few() + "0" + few() + "::1");
}

TEST_F(HalfOpenLimitTest, MatchesANaiveRecount) {
  SplitMix64 random(16);
  int ended = 0, refused = 0;
  for (int round = 0; round < 20; ++round) {
    const HalfOpenLimit::Limits limits{5 + random.below(30), 3 + random.below(10)};
    HalfOpenLimit tested(limits);
    NaiveLimit naive(limits);
    const auto drop = [&](std::size_t at) {
      tested.release(naive.entries[at].id);
      naive.entries.erase(naive.entries.begin() + static_cast<std::ptrdiff_t>(at));
    };
    for (int step = 0; step < 1000; ++step) {
      const std::size_t some = naive.entries.empty() ? 0 : random.below(naive.entries.size());
      const std::uint64_t what = random.below(8);
      if (what == 0 && !naive.entries.empty()) drop(some);
      if (what == 1 && !naive.entries.empty()) {
        NaiveLimit::Entry& entry = naive.entries[some];
        entry.greeted = entry.greeted || !naive.hasItsShare(entry.prefix);
        ASSERT_EQ(tested.onHello(entry.id), entry.greeted) << round << " " << step;
      }
      const AddressPrefix prefix = randomPrefix(random);
      const auto verdict = tested.check(prefix);
      const auto expected = naive.check(prefix);
      ASSERT_EQ(verdict.kind, expected.kind) << round << " " << step;
      ASSERT_EQ(verdict.id, expected.id) << round << " " << step;
      if (verdict.kind == Kind::kEvictFirst) {
        ++ended;
        drop(static_cast<std::size_t>(std::find_if(naive.entries.begin(), naive.entries.end(),
                                                   [&](const auto& e) { return e.id == verdict.id; }) -
                                      naive.entries.begin()));
      }
      if (verdict.kind == Kind::kFits || verdict.kind == Kind::kEvictFirst) {
        tested.admit(++newest, prefix);
        naive.entries.push_back({newest, prefix, false});
      } else {
        ++refused;
      }
      ASSERT_EQ(tested.count(), naive.entries.size());
    }
  }
  EXPECT_GT(ended, 1000);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace naiad
