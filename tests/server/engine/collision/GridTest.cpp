#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/collision/Grid.h"
#include "engine/world/Random.h"

namespace df::test {
namespace {

std::vector<Grid::Slot> sorted(std::vector<Grid::Slot> slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

/// A grid with the arrays that it reads.
struct Filed {
  std::vector<FixedVector> positions;
  std::vector<FixedBox> boxes;
  std::vector<bool> filed;
  Grid grid{positions, boxes};

  explicit Filed(std::size_t slots) : positions(slots), boxes(slots), filed(slots) {}
  void put(Grid::Slot s, FixedVector position, const FixedBox& box) {
    const bool only_moved = filed[s] && boxes[s] == box;
    positions[s] = position;
    boxes[s] = box;
    if (only_moved) {
      grid.refile(s);
    } else {
      grid.file(s);
    }
    filed[s] = true;
  }
  void remove(Grid::Slot s) {
    grid.remove(s);
    filed[s] = false;
  }
  std::vector<Grid::Slot> touching(const FixedBox& box, Grid::Slot self) const {
    std::vector<Grid::Slot> expected;
    for (Grid::Slot s = 0; s < filed.size(); ++s) {
      if (filed[s] && s != self && intersects(translate(boxes[s], positions[s]), box)) expected.push_back(s);
    }
    return expected;
  }
};

FixedVector randomPosition(Random& random, int spread) {
  const auto number = [&] { return static_cast<Fixed>(random.below(spread)) * (kFixedOne / 4); };
  return {number() - number(), number() - number()};
}

FixedBox randomBox(Random& random) {
  const auto number = [&](int below) { return static_cast<Fixed>(random.below(below)) * (kFixedOne / 4); };
  // Half of the boxes are characters, some sprites and walls, and a few have the maximum size.
  const int kind = random.below(20);
  if (kind < 10) return kCharacterBox;
  const int size = kind == 10 ? 4000000 : kind < 14 ? 400 : kind < 18 ? 60 : 5;
  return {{number(size) - number(size), number(size) - number(size)}, {number(size), number(size)}};
}

TEST(Grid, FindsTouchingBoxesOfAnySizeAnywhere) {
  Random random(7);
  for (const int spread : {20, 400, 40000, 2000000000}) {
    Filed it(400);
    for (int round = 0; round < 4000; ++round) {
      const auto slot = static_cast<Grid::Slot>(random.below(400));
      if (random.below(6) == 0) {
        it.remove(slot);
      } else {
        it.put(slot, randomPosition(random, spread),
               random.below(2) == 0 && it.filed[slot] ? it.boxes[slot] : randomBox(random));
      }
      const FixedBox asked = translate(randomBox(random), randomPosition(random, spread));
      std::vector<Grid::Slot> found;
      it.grid.touching(asked, slot, found);
      ASSERT_EQ(sorted(found), it.touching(asked, slot)) << "spread " << spread << " round " << round;
    }
    ASSERT_EQ(it.grid.size(), std::count(it.filed.begin(), it.filed.end(), true));
  }
}

TEST(Grid, FarAwayBoxesAreNotVisited) {
  Filed it(10000);
  for (Grid::Slot s = 0; s < 10000; ++s) it.put(s, {fromCells(static_cast<int>(s) * 10), 0}, kCharacterBox);
  int visited = 0;
  it.grid.visitCorners(0, {fromCells(5000), 0}, {fromCells(5002), 0}, [&](Grid::Slot) { ++visited; });
  EXPECT_LE(visited, 4);
}

// Boxes on a lattice whose step is a power of two must be spread over many cells.
TEST(Grid, RegularLatticeSpreadsOverManyCells) {
  for (const int step : {64, 1024, 65536}) {
    Filed it(10000);
    for (Grid::Slot s = 0; s < 10000; ++s) {
      it.put(s, {fromCells(static_cast<int>(s % 100) * step), fromCells(static_cast<int>(s / 100) * step)},
             kCharacterBox);
    }
    int visited = 0;
    for (Grid::Slot s = 0; s < 10000; ++s) {
      const FixedVector p = it.positions[s];
      it.grid.visitCorners(0, p - FixedVector{kFixedOne, kFixedOne}, p, [&](Grid::Slot) { ++visited; });
    }
    EXPECT_LE(visited, 8 * 10000) << "step " << step;
  }
}

TEST(Grid, MemoryGrowsWithBoxCountNotWorldSize) {
  Random random(10);
  Filed it(10000);
  for (Grid::Slot s = 0; s < 10000; ++s) it.put(s, randomPosition(random, 4000000), kCharacterBox);
  EXPECT_LE(it.grid.bytes(), 3u << 20);
  for (Grid::Slot s = 100; s < 10000; ++s) it.remove(s);
  EXPECT_LE(it.grid.bytes(), 768u << 10);
}

}  // namespace
}  // namespace df::test
