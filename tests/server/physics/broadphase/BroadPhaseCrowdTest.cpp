// Crowds in the broad phase: the rule that limits their pairs, and a cost that is proportional to the bodies.

#include <cstdlib>
#include <set>
#include <tuple>
#include <utility>

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

// Makes bounds of whole numbers, so that many of them have equal distances.
GridBounds around(SplitMix64& random, Vec2 where, double spread, double size) {
  const auto whole = [&](double most) { return static_cast<std::int64_t>(between(random, 0, most)); };
  const auto x = static_cast<std::int64_t>(where.x) + whole(spread);
  const auto y = static_cast<std::int64_t>(where.y) + whole(spread);
  const auto half = static_cast<std::int64_t>(size), longer = half + whole(0.5 * size);
  return {x - half, y - longer, x + half, y + longer};
}

// Finds pairs by the rule, by comparison of all members. Members are sorted by order, the oldest first.
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
  // Returns how many pairs with larger members the rule has dropped so far.
  std::size_t sparedLarger() const { return m_spared_larger; }

 private:
  enum class Kind : std::uint8_t { kOther, kHeaped, kAlike, kUnlike };
  static Kind kindOf(const Member& own, const Member& that) {
    if (!own.moves || !that.moves) return Kind::kOther;
    const auto [x, width_x, other_x] =
        along(own.bounds.lower_x, own.bounds.upper_x, that.bounds.lower_x, that.bounds.upper_x);
    const auto [y, width_y, other_y] =
        along(own.bounds.lower_y, own.bounds.upper_y, that.bounds.lower_y, that.bounds.upper_y);
    if (x < 2 * std::min(width_x, other_x) && y < 2 * std::min(width_y, other_y)) return Kind::kHeaped;
    return areAlike(width_x, other_x) && areAlike(width_y, other_y) ? Kind::kAlike : Kind::kUnlike;
  }
  static std::int64_t areaOf(const Member& member) {
    const GridBounds& b = member.bounds;
    return (b.upper_x - b.lower_x) * (b.upper_y - b.lower_y);
  }
  static bool isSmaller(std::size_t i, std::size_t j, const std::vector<Member>& members) {
    const std::int64_t one = areaOf(members[i]), other = areaOf(members[j]);
    return one != other ? one < other : i < j;
  }
  // If both have changed, the smaller one finds the pair; if they are of like size, the older one.
  static bool finds(std::size_t i, std::size_t j, const std::vector<Member>& members, Kind kind) {
    if (!members[j].is_changed) return true;
    return kind == Kind::kUnlike ? isSmaller(i, j, members) : i < j;
  }

  void addOf(std::size_t i, const std::vector<Member>& members, OrderPairs& found) {
    using Near = std::vector<std::tuple<std::int64_t, std::size_t>>;  // square of the distance, and index of
                                                                      // the other
    Near near, larger;
    std::size_t heaped = 0, found_heaped = 0;
    for (std::size_t j = 0; j < members.size(); ++j) {
      const Member &own = members[i], &that = members[j];
      if (i == j || !overlap(own.bounds, that.bounds) || (!own.moves && !that.moves)) continue;
      const Kind kind = kindOf(own, that);
      heaped += kind == Kind::kHeaped ? 1 : 0;
      if (!finds(i, j, members, kind)) continue;
      found_heaped += kind == Kind::kHeaped ? 1 : 0;
      const auto x = std::get<0>(
          along(own.bounds.lower_x, own.bounds.upper_x, that.bounds.lower_x, that.bounds.upper_x));
      const auto y = std::get<0>(
          along(own.bounds.lower_y, own.bounds.upper_y, that.bounds.lower_y, that.bounds.upper_y));
      if (kind == Kind::kOther || (kind == Kind::kUnlike && isSmaller(j, i, members))) {
        found.insert(std::minmax(i, j));
      } else {
        (kind == Kind::kUnlike ? larger : near).emplace_back(x * x + y * y, j);
      }
    }
    const auto keep = [&](Near& of, bool is_thick) {
      std::sort(of.begin(), of.end());
      if (is_thick && of.size() > kNearest) of.resize(kNearest);
      for (const auto& [square, j] : of) found.insert(std::minmax(i, j));
    };
    keep(near, found_heaped > kMaxHeaped);
    const std::size_t all = larger.size();
    keep(larger, heaped > kMaxHeaped);
    m_spared_larger += all - larger.size();
  }
  // Returns twice the distance of the centres, and both widths, along one axis.
  static std::tuple<std::int64_t, std::int64_t, std::int64_t> along(std::int64_t a, std::int64_t b,
                                                                    std::int64_t c, std::int64_t d) {
    return {std::abs(a + b - c - d), b - a, d - c};
  }
  static bool areAlike(std::int64_t a, std::int64_t b) { return 2 * std::min(a, b) >= std::max(a, b); }

  OrderPairs m_pairs;
  std::size_t m_spared_larger = 0;
};

// Three crowds, one of mixed sizes, move through each other and through other bodies, some of them immovable.
// In some ticks most of them move, in others only a few.
TEST(BroadPhaseCrowd, PairLimitMatchesTheReferenceRule) {
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
    std::vector<std::size_t> sequence(members.size());  // order in which they are added
    for (std::size_t i = 0; i < sequence.size(); ++i) sequence[i] = (i * 7) % sequence.size();
    const std::size_t last = members.size() - 1;  // ids are in the opposite order
    for (std::uint32_t i = 0; i < 50; ++i) members[i].proxy = broad.add(1000 + i, members[i].bounds, true);
    broad.updatePairs();
    for (std::size_t i = 0; i < 50; ++i) broad.remove(members[i].proxy);  // these proxies are reused
    broad.updatePairs();
    for (const std::size_t i : sequence) {
      const auto id = static_cast<std::uint32_t>(last - i);
      members[i].proxy = broad.add(id, members[i].bounds, members[i].moves, i);
    }
    Rule rule;
    std::size_t thinned = 0;
    for (int tick = 0; tick < 12; ++tick) {
      OrderPairs found;
      for (const BroadPhasePair& pair : broad.updatePairs())
        found.insert(std::minmax(last - pair.id_a, last - pair.id_b));
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
    EXPECT_GT(rule.sparedLarger(), 100U);
  }
}

struct CrowdOf {
  double spread;
  double least;  // smallest half width; the largest is 32
};

// Crowds in one cell, in a tenth of a cell, and in one place, of like and of mixed sizes.
TEST(BroadPhaseCrowd, CostGrowsWithBodiesNotPairs) {
  for (const auto& [spread, least] : {CrowdOf{64, 32}, CrowdOf{6.4, 32}, CrowdOf{0, 32}, CrowdOf{64, 3.2},
                                      CrowdOf{6.4, 3.2}, CrowdOf{0, 3.2}}) {
    const double most_pairs = least < 32 ? 2 * kNearest + 1 : kNearest + 1;
    std::vector<double> looks;  // per body and tick
    for (const int count : {1000, 4000}) {
      SplitMix64 random(7);
      BroadPhase broad(true);
      std::vector<std::int32_t> proxies;
      for (int i = 0; i < count; ++i) {
        const GridBounds bounds = around(random, {}, spread, between(random, least, 32));
        const auto number = static_cast<std::uint32_t>(i);
        proxies.push_back(broad.add(number, bounds, true, number));
      }
      for (int tick = 0; tick < 2; ++tick) {
        EXPECT_LE(static_cast<double>(broad.updatePairs().size()), most_pairs * count)
            << spread << ' ' << least;
        for (const std::int32_t proxy : proxies) {
          GridBounds bounds = broad.bounds(proxy);
          const auto wider = static_cast<std::int64_t>(between(random, 0, 30));
          bounds.upper_x += wider, bounds.lower_y -= wider;
          broad.set(proxy, bounds);
        }
      }
      looks.push_back(0.5 * static_cast<double>(broad.looks()) / count);
    }
    EXPECT_LT(looks[1], 2 * looks[0]) << spread << ' ' << least;
    EXPECT_LT(looks[1], 300) << spread << ' ' << least;
  }
}

}  // namespace
}  // namespace naiad::physics
