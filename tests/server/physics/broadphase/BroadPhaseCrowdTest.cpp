// Crowds in the broad phase: the rule by which they are thinned, and that it costs no more than they are
// many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "physics/broadphase/BroadPhase.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

using test::between;

constexpr std::size_t kMaxHeaped = 32, kNearest = 16;

struct Member {
  GridBounds bounds;
  bool moves;
  std::int32_t proxy = -1;
  bool is_changed = true;
};
using OrderPairs = std::set<std::pair<std::size_t, std::size_t>>;

// Whole numbers, so that many are equally far from each other.
GridBounds around(SplitMix64& random, Vec2 where, double spread, double size) {
  const auto whole = [&](double most) { return static_cast<std::int64_t>(between(random, 0, most)); };
  const auto x = static_cast<std::int64_t>(where.x) + whole(spread);
  const auto y = static_cast<std::int64_t>(where.y) + whole(spread);
  const auto half = static_cast<std::int64_t>(size), longer = half + whole(0.5 * size);
  return {x - half, y - longer, x + half, y + longer};
}

// By the rule, of every two: of members by order, the older ones first.
class Rule {
 public:
  OrderPairs update(const std::vector<Member>& members) {
    OrderPairs found;
    for (const auto& pair : m_pairs) {
      if (!members[pair.first].is_changed && !members[pair.second].is_changed) found.insert(pair);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].is_changed) addOf(i, members, found);
    }
    return m_pairs = found;
  }

 private:
  void addOf(std::size_t i, const std::vector<Member>& members, OrderPairs& found) {
    const Member& own = members[i];
    std::vector<std::tuple<std::int64_t, std::size_t>> near;  // by square of the distance
    std::size_t heaped = 0;
    for (std::size_t j = 0; j < members.size(); ++j) {
      const Member& that = members[j];
      if (i == j || (that.is_changed && j < i) || !overlap(own.bounds, that.bounds)) continue;
      if (!own.moves && !that.moves) continue;
      const auto [x, width_x, other_x] =
          along(own.bounds.lower_x, own.bounds.upper_x, that.bounds.lower_x, that.bounds.upper_x);
      const auto [y, width_y, other_y] =
          along(own.bounds.lower_y, own.bounds.upper_y, that.bounds.lower_y, that.bounds.upper_y);
      const bool do_move = own.moves && that.moves;
      const bool are_heaped =
          do_move && x < 2 * std::min(width_x, other_x) && y < 2 * std::min(width_y, other_y);
      const bool are_alike = do_move && areAlike(width_x, other_x) && areAlike(width_y, other_y);
      heaped += are_heaped ? 1 : 0;
      if (are_heaped || are_alike) {
        near.emplace_back(x * x + y * y, j);
      } else {
        found.insert(std::minmax(i, j));
      }
    }
    std::sort(near.begin(), near.end());
    if (heaped > kMaxHeaped) near.resize(kNearest);
    for (const auto& [square, j] : near) found.insert(std::minmax(i, j));
  }
  // Twice the distance of the middles, and both widths.
  static std::tuple<std::int64_t, std::int64_t, std::int64_t> along(std::int64_t a, std::int64_t b,
                                                                    std::int64_t c, std::int64_t d) {
    return {std::abs(a + b - c - d), b - a, d - c};
  }
  static bool areAlike(std::int64_t a, std::int64_t b) { return 2 * std::min(a, b) >= std::max(a, b); }

  OrderPairs m_pairs;
};

// Three crowds, one of them of all sizes, that move through each other, among others and what never moves;
// all of them, or a few.
TEST(BroadPhaseCrowd, IsThinnedByTheRule) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SplitMix64 random(seed);
    BroadPhase broad(true);
    std::vector<Member> members;
    const auto addSome = [&](int count, Vec2 where, double spread, double least, double most, bool moves) {
      for (int i = 0; i < count; ++i)
        members.push_back({around(random, where, spread, between(random, least, most)), moves});
    };
    addSome(150, {0, 0}, 20, 32, 36, true);
    addSome(120, {60, 0}, 3, 32, 60, true);
    addSome(100, {30, 40}, 40, 4, 100, true);
    addSome(60, {-200, -200}, 500, 20, 40, true);
    addSome(30, {-100, -100}, 300, 20, 60, false);
    std::vector<std::size_t> sequence(members.size());  // in which they come
    for (std::size_t i = 0; i < sequence.size(); ++i) sequence[i] = (i * 7) % sequence.size();
    for (const std::size_t i : sequence) {
      members[i].proxy = broad.add(static_cast<std::uint32_t>(i), members[i].bounds, members[i].moves, i);
    }
    Rule rule;
    std::size_t thinned = 0;
    for (int tick = 0; tick < 12; ++tick) {
      OrderPairs found;
      for (const BroadPhasePair& pair : broad.updatePairs()) found.insert({pair.id_a, pair.id_b});
      ASSERT_EQ(found, rule.update(members)) << seed << ' ' << tick;
      for (Member& member : members) {
        thinned += broad.isThinned(member.proxy) ? 1 : 0;
        member.is_changed = member.moves && random.unit() < (tick % 3 == 2 ? 0.05 : 0.9);
        if (!member.is_changed) continue;
        const auto x = static_cast<std::int64_t>(between(random, -9, 9));
        GridBounds& b = member.bounds;
        b = {b.lower_x + x, b.lower_y - 2, b.upper_x + x + (x > 6 ? 3 : 0), b.upper_y};
        broad.set(member.proxy, b);
      }
    }
    EXPECT_GT(thinned, 1000U);
  }
}

// In one cell, in a tenth of it, and in one place.
TEST(BroadPhaseCrowd, CostsByItsBodiesNotByTheirPairs) {
  for (const double spread : {64.0, 6.4, 0.0}) {
    std::vector<double> looks;  // of each body in a tick
    for (const int count : {1000, 4000}) {
      SplitMix64 random(7);
      BroadPhase broad(true);
      std::vector<std::int32_t> proxies;
      for (int i = 0; i < count; ++i) {
        const GridBounds bounds = around(random, {}, spread, 32);
        const auto number = static_cast<std::uint32_t>(i);
        proxies.push_back(broad.add(number, bounds, true, number));
      }
      for (int tick = 0; tick < 2; ++tick) {
        EXPECT_LE(broad.updatePairs().size(), (kNearest + 1) * static_cast<std::size_t>(count));
        for (const std::int32_t proxy : proxies) {
          GridBounds bounds = broad.bounds(proxy);
          const auto wider = static_cast<std::int64_t>(between(random, 0, 30));
          bounds.upper_x += wider, bounds.lower_y -= wider;
          broad.set(proxy, bounds);
        }
      }
      looks.push_back(0.5 * static_cast<double>(broad.looks()) / count);
    }
    EXPECT_LT(looks[1], 2 * looks[0]) << spread;
    EXPECT_LT(looks[1], 300) << spread;
  }
}

}  // namespace
}  // namespace naiad::physics
