// Sweeps in hand-made cases. The oracle compares the rules with an implementation of its own in random
// worlds, some of them at the ends of the number range.
#include <gtest/gtest.h>

#include "engine/collision/Mask.h"
#include "engine/collision/Sweep.h"
#include "tests/support/CellsAt.h"

namespace df::test {
namespace {

using naiad::test::cellsAt;

constexpr Fixed kFar = 2000000000 * kFixedOne;

TEST(Moments, AreComparedAsExactFractions) {
  constexpr std::uint64_t kMax = UINT64_MAX;
  EXPECT_EQ((Moment{1, 2}), (Moment{3, 6}));
  EXPECT_EQ((Moment{0, 1}), (Moment{0, kMax}));
  EXPECT_EQ((Moment{kMax, kMax}), (Moment{1, 1}));
  EXPECT_LT((Moment{kMax - 1, kMax}), (Moment{1, 1}));
  EXPECT_LT((Moment{kMax - 2, kMax - 1}), (Moment{kMax - 1, kMax}));
  EXPECT_GT((Moment{1, kMax - 1}), (Moment{1, kMax}));
  EXPECT_LT((Moment{5, kMax}), (Moment{6, kMax}));
  EXPECT_EQ((Moment{1, 4}).toDouble(), 0.25);
}

class MaskedMove : public testing::Test {
 protected:
  static FixedBox boxAt(int x, int y, int width, int height) {
    return {{fromCells(x - 1), fromCells(y - 1)}, {fromCells(width), fromCells(height)}};
  }
  // Returns the sweep of a mask whose first character is in cell (0,0) of its position.
  static Sweep sweep(const Mask& mask, FixedVector from, FixedVector to) {
    return {boxAt(0, 0, mask.width(), mask.height()), from, to};
  }
};

TEST_F(MaskedMove, LargestBoxIsHitOnlyBySetCells) {
  // A ship of two rows, the lower one empty, above the wall. Only the empty row is level with the wall.
  const Mask ship = *Mask::fromRows({"####", "    "});
  const FixedBox wall = boxAt(0, 0, 1000000, 1);
  const Sweep along = sweep(ship, cellsAt(-100, -1), cellsAt(2000000, -1));
  EXPECT_TRUE(along.firstTouch(wall));
  EXPECT_EQ(along.firstShare(&ship, wall, nullptr), std::nullopt);
  // The ship sinks by one cell on the way, so its upper row is level with the wall at the end.
  const Sweep sinking = sweep(ship, cellsAt(0, -1), cellsAt(900000, 0));
  EXPECT_EQ(sinking.firstShare(&ship, wall, nullptr), (Moment{1, 1}));
  // The wall moves up instead of the ship down.
  const Sweep rising(boxAt(0, 0, 1000000, 1), cellsAt(-900000, 0), cellsAt(0, -1));
  EXPECT_EQ(rising.firstShare(nullptr, boxAt(0, -1, 4, 2), &ship),
            (Moment{1, static_cast<std::uint64_t>(kFixedOne)}));
}

TEST(FarAndFast, MasksMeetAtTheEndOfTheFastestMove) {
  const Mask mask = *Mask::fromRows({"# ", " #"});
  const FixedBox box = {{-kFixedOne, -kFixedOne}, {2 * kFixedOne, 2 * kFixedOne}};
  const Sweep sweep(box, {-kFar, -kFar}, {kFar, kFar});
  const FixedBox wall = translate({{}, {fromCells(1000000), fromCells(1000000)}}, {kFar, kFar});
  // The boxes' corners touch one cell before the target, the characters only at the target.
  const auto way = static_cast<std::uint64_t>(kFar) * 2;
  EXPECT_EQ(sweep.firstTouch(wall), (Moment{way - kFixedOne, way}));
  EXPECT_EQ(sweep.firstShare(&mask, wall, nullptr), (Moment{1, 1}));
  EXPECT_EQ(sweep.firstShare(&mask, translate(wall, {kFixedOne, 0}), nullptr), std::nullopt);
}

}  // namespace
}  // namespace df::test
