#include <utility>

#include "physics/broadphase/ImpactTree.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

using ItemPairs = std::vector<std::pair<int, int>>;

struct Boxes {
  std::vector<SweptBox> boxes;
  std::vector<int> ids;
  int limit = 0;
};

// Returns small and some large boxes, some of them in one place. Every third id is unused.
Boxes randomBoxes(SplitMix64& random, int count, double spread) {
  Boxes made;
  for (int i = 0; i < count; ++i) {
    const Vec2 low = i % 10 == 0 ? Vec2{} : test::anyVec(random, spread);
    const double width = test::between(random, 0, i % 7 == 0 ? 20 : 2);
    made.boxes.push_back({low, low + Vec2{width, test::between(random, 0, 2)}});
    made.ids.push_back(i + i / 2);
  }
  made.limit = 2 * count;
  return made;
}

ItemPairs allPairs(const Boxes& of) {
  ItemPairs pairs;
  for (std::size_t i = 0; i < of.boxes.size(); ++i) {
    for (std::size_t k = i + 1; k < of.boxes.size(); ++k) {
      if (overlaps(of.boxes[i], of.boxes[k])) pairs.emplace_back(of.ids[i], of.ids[k]);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// The boxes move, and the tree is refitted or rebuilt.
TEST(ImpactTree, FindsEveryPairOnce) {
  SplitMix64 random(5);
  ImpactTree tree;
  std::size_t found = 0;
  for (const int count : {0, 1, 2, 3, 10, 100, 400}) {
    for (const double spread : {0.0, 5.0, 100.0}) {
      Boxes made = randomBoxes(random, count, spread);
      for (int tick = 0; tick < 20; ++tick) {
        tree.update(made.boxes, made.ids, made.limit);
        ItemPairs pairs;
        tree.queryPairs([&](int i, int j) { pairs.emplace_back(i, j); });
        std::sort(pairs.begin(), pairs.end());
        ASSERT_EQ(pairs, allPairs(made)) << count << ' ' << spread << ' ' << tick;
        found += pairs.size();
        for (SweptBox& box : made.boxes) {
          const Vec2 displacement = test::anyVec(random, 1);
          box = {box.low + displacement, box.high + displacement};
        }
      }
    }
  }
  EXPECT_GT(found, 10'000u);
}

// The groups connected by the pairs found. Each group is named by its lowest id.
class Together {
 public:
  explicit Together(int limit) : m_parent(static_cast<std::size_t>(limit)) {
    for (int i = 0; i < limit; ++i) m_parent[static_cast<std::size_t>(i)] = i;
  }
  int of(int i) const {
    while (m_parent[static_cast<std::size_t>(i)] != i) i = m_parent[static_cast<std::size_t>(i)];
    return i;
  }
  void join(int i, int j) {
    const int one = of(i), other = of(j);
    m_parent[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
  }

 private:
  std::vector<int> m_parent;
};

TEST(ImpactTree, FindsGroupsWithoutListingAllPairs) {
  SplitMix64 random(7);
  ImpactTree tree;
  for (const int count : {0, 1, 2, 3, 10, 100, 400}) {
    for (const double spread : {0.0, 5.0, 100.0}) {
      const Boxes made = randomBoxes(random, count, spread);
      tree.update(made.boxes, made.ids, made.limit);
      Together expected(made.limit), found(made.limit);
      for (const auto& [i, j] : allPairs(made)) expected.join(i, j);
      ItemPairs pairs;
      const auto join = [&](int i, int j) {
        ASSERT_LT(i, j);
        pairs.emplace_back(i, j);
        found.join(i, j);
      };
      tree.queryGroups(join, [&](int i, int j) { return found.of(i) == found.of(j); });
      for (int i = 0; i < made.limit; ++i) ASSERT_EQ(found.of(i), expected.of(i)) << count << ' ' << spread;
      ASSERT_LT(pairs.size(), made.ids.size() + 1);  // there are no pairs within a group that is already
                                                     // connected
      std::sort(pairs.begin(), pairs.end());
      const ItemPairs all = allPairs(made);
      ASSERT_TRUE(std::includes(all.begin(), all.end(), pairs.begin(), pairs.end()));
    }
  }
}

// Each pair of boxes that are in no known group is found once.
TEST(ImpactTree, UngroupedBoxesGetEveryPairOnce) {
  SplitMix64 random(8);
  ImpactTree tree;
  const Boxes made = randomBoxes(random, 300, 5);
  tree.update(made.boxes, made.ids, made.limit);
  Together together(made.limit);
  ItemPairs pairs;
  const auto goesItsOwnWay = [](int i) { return i % 30 == 0; };
  tree.queryGroups(
      [&](int i, int j) {
        pairs.emplace_back(i, j);
        if (!goesItsOwnWay(i) && !goesItsOwnWay(j)) together.join(i, j);
      },
      [&](int i, int j) { return together.of(i) == together.of(j); });
  std::sort(pairs.begin(), pairs.end());
  ASSERT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
  for (const std::pair<int, int>& pair : allPairs(made)) {
    if (!goesItsOwnWay(pair.first) && !goesItsOwnWay(pair.second)) continue;
    ASSERT_TRUE(std::binary_search(pairs.begin(), pairs.end(), pair)) << pair.first << ' ' << pair.second;
  }
}

TEST(ImpactTree, QueryStopsWhenTheCallbackReturnsFalse) {
  SplitMix64 random(9);
  ImpactTree tree;
  const Boxes made = randomBoxes(random, 100, 0);
  tree.update(made.boxes, made.ids, made.limit);
  int found = 0;
  tree.query(made.boxes[0], [&](int /*id*/) { return ++found < 5; });
  EXPECT_EQ(found, 5);
}

}  // namespace
}  // namespace naiad::physics
