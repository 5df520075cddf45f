#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "Grid.h"
#include "Random.h"

namespace df::test {
namespace {

FixedBox boxOf(Random& random, int spread) {
  const auto number = [&](int below) { return static_cast<Fixed>(random.below(below)) * (kFixedOne / 4); };
  // Mostly characters, some walls, a few as large as boxes get.
  const int kind = random.below(20);
  const int size = kind == 0 ? 4000000 : kind < 4 ? 400 : 5;
  return {{number(spread) - number(spread), number(spread) - number(spread)}, {number(size), number(size)}};
}

TEST(Grid, QueryFindsExactlyWhatTouchesOfAllThatItReturns) {
  Random random(7);
  for (const int spread : {40, 4000, 2000000000}) {
    Grid grid;
    std::vector<FixedBox> boxes;
    for (int i = 0; i < 300; ++i) boxes.push_back(boxOf(random, spread));
    std::vector<bool> filed(boxes.size());
    for (int round = 0; round < 2000; ++round) {
      const auto slot = static_cast<Grid::Slot>(random.below(300));
      if (random.below(4) == 0) {
        grid.remove(slot);
        filed[slot] = false;
      } else {
        boxes[slot] = boxOf(random, spread);
        grid.put(slot, boxes[slot]);
        filed[slot] = true;
      }
      const FixedBox asked = boxOf(random, spread);
      std::vector<Grid::Slot> found;
      grid.query(asked, found);
      std::sort(found.begin(), found.end());
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      for (Grid::Slot s = 0; s < 300; ++s) {
        const bool is_found = std::binary_search(found.begin(), found.end(), s);
        ASSERT_TRUE(is_found || !filed[s] || !intersects(boxes[s], asked)) << s;
        ASSERT_TRUE(filed[s] || !is_found) << s;
      }
    }
    ASSERT_EQ(grid.size(), std::count(filed.begin(), filed.end(), true));
  }
}

TEST(Grid, FarAwayBoxesAreNotReturned) {
  Grid grid;
  for (Grid::Slot s = 0; s < 10000; ++s) {
    grid.put(s, {{fromCells(static_cast<int>(s) * 10), 0}, {kFixedOne, kFixedOne}});
  }
  std::vector<Grid::Slot> found;
  grid.query({{fromCells(5000), 0}, {kFixedOne, kFixedOne}}, found);
  EXPECT_LE(found.size(), 4u);
}

}  // namespace
}  // namespace df::test
