#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

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

// Most of them small, some large, some in one place; every third id is free.
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

TEST(ImpactTree, FindsEveryPairOnce) {
  SplitMix64 random(5);
  ImpactTree tree;
  std::size_t found = 0;
  for (const int count : {0, 1, 2, 3, 10, 100, 400}) {
    for (const double spread : {0.0, 5.0, 100.0}) {
      const Boxes made = randomBoxes(random, count, spread);
      tree.update(made.boxes, made.ids, made.limit);
      ItemPairs pairs;
      tree.queryPairs([&](int i, int j) { pairs.emplace_back(i, j); });
      std::sort(pairs.begin(), pairs.end());
      ASSERT_EQ(pairs, allPairs(made)) << count << ' ' << spread;
      found += pairs.size();
    }
  }
  EXPECT_GT(found, 10'000u);
}

// Also when the boxes have moved, and the tree is the old one.
TEST(ImpactTree, FindsEveryPairOfThoseThatMove) {
  SplitMix64 random(6);
  ImpactTree tree;
  Boxes made = randomBoxes(random, 200, 30);
  for (int tick = 0; tick < 50; ++tick) {
    tree.update(made.boxes, made.ids, made.limit);
    ItemPairs pairs;
    tree.queryPairs([&](int i, int j) { pairs.emplace_back(i, j); });
    std::sort(pairs.begin(), pairs.end());
    ASSERT_EQ(pairs, allPairs(made)) << tick;
    for (SweptBox& box : made.boxes) {
      const Vec2 displacement = test::anyVec(random, 1);
      box = {box.low + displacement, box.high + displacement};
    }
  }
}

}  // namespace
}  // namespace naiad::physics
