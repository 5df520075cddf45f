// Sweeps in hand-made cases.
#include <gtest/gtest.h>

#include "PlainSweep.h"

namespace df::test {
namespace {

// ---- Moments.

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

// ---- The rules of docs/collisions.md.

const FixedBox kCharacter = {{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}};

TEST(SweptMove, FastArrowHitsTheWindow) {
  const FixedBox arrow = {cells(-2, -0.5), cells(4, 1)};
  const FixedBox window = translate(kCharacter, cells(21, 0));
  const Sweep sweep(arrow, cells(10, 0), cells(25, 0));
  ASSERT_FALSE(intersects(translate(arrow, cells(25, 0)), window));
  const std::optional<Moment> touch = sweep.firstTouch(window);
  ASSERT_TRUE(touch);
  EXPECT_EQ(*touch, (Moment{17, 30}));  // the arrow's tip moves from 12 to the glass at 20.5: 8.5 of 15 cells
  EXPECT_EQ(sweep.before(*touch), (FixedVector{fromCells(10) + 17 * (kFixedOne / 2) - 1, 0}));
}

TEST(SweptMove, BoxesOffThePathAreNotHit) {
  const Sweep sweep(kCharacter, cells(0, 0), cells(10, 5));
  const auto isHit = [&](double x, double y) {
    return sweep.firstTouch(translate(kCharacter, cells(x, y))).has_value();
  };
  EXPECT_TRUE(isHit(6, 3));
  EXPECT_TRUE(isHit(11, 6)) << "the edges touch at the target";
  EXPECT_TRUE(isHit(6, 4.5)) << "the corners touch on the way";
  EXPECT_FALSE(isHit(6, 4.6));
  EXPECT_FALSE(isHit(11.01, 5));
  EXPECT_FALSE(isHit(-2, -1));
  EXPECT_FALSE(isHit(0, 5));
}

TEST(SweptMove, AxisMovesOnlyAfterAFullUnit) {
  // Moves two units to the right and three down: x becomes 1 at t = 1/2, while y is 1.
  const Sweep sweep({{}, {}}, {0, 0}, {2, 3});
  EXPECT_EQ(sweep.firstTouch({{1, 1}, {}}), (Moment{1, 2}));
  EXPECT_EQ(sweep.firstTouch({{0, 1}, {}}), (Moment{1, 3}));
  EXPECT_EQ(sweep.firstTouch({{1, 2}, {}}), (Moment{2, 3}));
  EXPECT_EQ(sweep.firstTouch({{2, 3}, {}}), (Moment{1, 1}));
  EXPECT_EQ(sweep.firstTouch({{1, 0}, {}}), std::nullopt) << "never at (1,0)";
  EXPECT_EQ(sweep.firstTouch({{0, 2}, {}}), std::nullopt);
  EXPECT_EQ(sweep.before({1, 2}), (FixedVector{0, 1}));
  EXPECT_EQ(sweep.before({2, 3}), (FixedVector{1, 1}));
  EXPECT_EQ(sweep.before({1, 1}), (FixedVector{1, 2}));
  EXPECT_EQ(sweep.before({0, 1}), (FixedVector{0, 0}));
}

// A character directly to the left of a wall two cells thick and ten high.
class AtTheWall : public testing::Test {
 protected:
  std::optional<Moment> touch(FixedVector by) const {
    return Sweep(kCharacter, start, start + by).firstTouch(wall);
  }

  const FixedVector start = cells(-0.5, 5);
  const FixedBox wall = {{0, 0}, {2 * kFixedOne, 10 * kFixedOne}};
};

TEST_F(AtTheWall, TouchingMoverHitsAtOnceUnlessLeaving) {
  for (const FixedVector by : {FixedVector{-1, 0}, cells(-20, 0), cells(-20, 3)}) {
    EXPECT_EQ(touch(by), std::nullopt) << "leaving by " << by.x << ", " << by.y;
  }
  EXPECT_EQ(touch({1, 0}), Moment{});
  EXPECT_EQ(touch(cells(20, 0)), Moment{}) << "on the other side at the end, but through the wall";
  EXPECT_EQ(touch(cells(1, 20)), Moment{});
  EXPECT_EQ(touch({0, 0}), Moment{}) << "standing still";
  EXPECT_EQ(touch(cells(0, 5.5)), Moment{}) << "the corners touch at the end";
  EXPECT_EQ(touch(cells(0, -2)), Moment{}) << "sliding along";
  EXPECT_EQ(touch(cells(0, 5.5) + FixedVector{0, 1}), std::nullopt) << "sliding beyond its end";
  EXPECT_EQ(touch(cells(0, -20)), std::nullopt);
}

TEST_F(AtTheWall, MoverOneUnitAwaySlidesFreely) {
  // The position of a mover that the wall has stopped.
  const Sweep arrival(kCharacter, cells(-10, 3), cells(10, 7));
  const std::optional<Moment> touch = arrival.firstTouch(wall);
  ASSERT_TRUE(touch);
  const FixedVector stop = arrival.before(*touch);
  EXPECT_EQ(stop.x, -kFixedOne / 2 - 1);
  for (const double way : {-20.0, -1.0, 0.0, 1.0, 20.0}) {
    EXPECT_EQ(Sweep(kCharacter, stop, stop + cells(0, way)).firstTouch(wall), std::nullopt) << way;
  }
  EXPECT_EQ(Sweep(kCharacter, stop, stop + FixedVector{1, 0}).firstTouch(wall), (Moment{1, 1}));
}

TEST_F(AtTheWall, InsideMoverLeavesFreelyByShortestPath) {
  // A position half a cell deep from the left, and five cells from above and below.
  const FixedVector inside = cells(0, 5);
  const auto touch_from = [&](FixedVector by) {
    return Sweep(kCharacter, inside, inside + by).firstTouch(wall);
  };
  EXPECT_EQ(touch_from(cells(-3, 0)), std::nullopt);
  EXPECT_EQ(touch_from(cells(-3, 20)), std::nullopt);
  EXPECT_EQ(touch_from(cells(-0.5, 0)), Moment{}) << "the edges still touch";
  EXPECT_EQ(touch_from(cells(3, 0)), Moment{}) << "deeper first";
  EXPECT_EQ(touch_from(cells(0, 20)), std::nullopt) << "no deeper, and out in the end";
}

TEST(SweptMove, GapClosesOnlyIfEveryLargestAxisCloses) {
  const FixedBox wall = {{0, 0}, cells(4, 4)};
  const auto closes = [&](FixedVector from, FixedVector by) {
    return Sweep(kCharacter, from, from + by).closesGap(wall);
  };
  EXPECT_TRUE(closes(cells(-3, 2), cells(1, 0)));
  EXPECT_FALSE(closes(cells(-3, 2), cells(0, 1)));
  EXPECT_FALSE(closes(cells(-3, 2), cells(-1, 0)));
  EXPECT_TRUE(closes(cells(7, 2), cells(-1, 9)));
  // Corner to corner: both axes have gap 0.
  const FixedVector corner = cells(-0.5, -0.5);
  EXPECT_TRUE(closes(corner, cells(1, 1)));
  EXPECT_FALSE(closes(corner, cells(1, 0)));
  EXPECT_FALSE(closes(corner, cells(1, -1)));
  // From the exact middle, every direction leads out.
  EXPECT_FALSE(closes(cells(2, 2), cells(1, 0)));
  EXPECT_FALSE(closes(cells(2, 2), cells(-1, 1)));
}

TEST(SweptMove, MovesOutIfGapIsLargerAtEnd) {
  const FixedBox wall = {{0, 0}, cells(4, 4)};
  const auto movesOut = [&](FixedVector from, FixedVector by) {
    return Sweep(kCharacter, from, from + by).movesOutOf(wall);
  };
  EXPECT_TRUE(movesOut(cells(1, 2), {-1, 0})) << "still inside, but less so";
  EXPECT_TRUE(movesOut(cells(1, 2), cells(20, 0))) << "by the long way";
  EXPECT_FALSE(movesOut(cells(1, 2), cells(2, 0))) << "as deep from the other side";
  EXPECT_FALSE(movesOut(cells(1, 2), cells(0, 0)));
  EXPECT_TRUE(movesOut(cells(-0.5, 2), {-1, 0}));
  EXPECT_FALSE(movesOut({-kFixedOne / 2 - 1, 0}, cells(-5, 0))) << "did not touch";
}

// ---- Masks on a path.

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

TEST_F(MaskedMove, ArrowFliesThroughAHoleOfItsHeight) {
  const Mask arrow = *Mask::fromRows({">-->"});
  const Mask gate = *Mask::fromRows({"#", "#", " ", "#"});
  const FixedBox box = boxAt(10, 0, 1, 4);
  for (int y = 0; y < 4; ++y) {
    const Sweep move = sweep(arrow, cells(0, y), cells(30, y));
    EXPECT_TRUE(move.firstTouch(box)) << y;
    // The arrow's tip enters the gate's cell after 7 cells.
    const auto expected = y == 2 ? std::nullopt : std::optional(Moment{7, 30});
    EXPECT_EQ(move.firstShare(&arrow, box, &gate), expected) << y;
  }
}

TEST_F(MaskedMove, NeighbouringRowsDoNotCollide) {
  const Mask dot = *Mask::fromRows({"o"});
  const Sweep move = sweep(dot, cells(0, 0), cells(20, 0));
  EXPECT_TRUE(move.firstTouch(boxAt(10, 1, 1, 1)));
  EXPECT_FALSE(move.firstShare(&dot, boxAt(10, 1, 1, 1), &dot));
  EXPECT_FALSE(move.firstShare(&dot, boxAt(10, 1, 1, 1), nullptr));
  EXPECT_FALSE(move.firstShare(nullptr, boxAt(10, 1, 1, 1), nullptr));
  EXPECT_TRUE(move.firstShare(nullptr, boxAt(10, 0, 1, 1), nullptr));
}

TEST_F(MaskedMove, DecreasingMoveEntersACellAtItsLastUnit) {
  const Mask dot = *Mask::fromRows({"o"});
  const Sweep move = sweep(dot, cells(5, 0), cells(-5, 0));
  const FixedBox other = boxAt(0, 0, 1, 1);
  // The path from cell 5 to the last unit of cell 0: four cells and one unit, out of ten cells.
  const auto way = static_cast<std::uint64_t>(10 * kFixedOne);
  const std::optional<Moment> share = move.firstShare(&dot, other, &dot);
  EXPECT_EQ(share, (Moment{static_cast<std::uint64_t>(4 * kFixedOne + 1), way}));
  EXPECT_EQ(move.before(*share), cells(1, 0));
}

TEST_F(MaskedMove, MayHitTheSameMaskAgainAfterLeaving) {
  // Two bars in a row: the mover begins in the first, leaves it and hits the second.
  const Mask bars = *Mask::fromRows({"#   #   "});
  const Mask dot = *Mask::fromRows({"o"});
  const FixedBox box = boxAt(0, 0, 8, 1);
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(-3, 0)).firstShare(&dot, box, &bars), std::nullopt);
  const Sweep through = sweep(dot, cells(0, 0), cells(10, 0));
  EXPECT_FALSE(through.closesGap(box)) << "the axis across is no deeper";
  EXPECT_EQ(through.firstShare(&dot, box, &bars), (Moment{4, 10}));
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(4, 0)).firstShare(&dot, box, &bars), Moment{})
      << "shares at the end";
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(3, 0)).firstShare(&dot, box, &bars), std::nullopt);
}

TEST_F(MaskedMove, MovesFreelyInsideARingUntilTheRim) {
  const Mask ring = *Mask::fromRows({"######", "#    #", "#    #", "#    #", "######"});
  const Mask dot = *Mask::fromRows({"o"});
  const FixedBox box = boxAt(0, 0, 6, 5);
  EXPECT_EQ(sweep(dot, cells(1, 1), cells(4, 3)).firstShare(&dot, box, &ring), std::nullopt);
  EXPECT_EQ(sweep(dot, cells(1, 2), cells(11, 2)).firstShare(&dot, box, &ring), (Moment{4, 10}));
  EXPECT_EQ(sweep(dot, cells(1, 2), cells(1, 2)).firstShare(&dot, box, &ring), std::nullopt);
}

TEST_F(MaskedMove, LargestBoxIsHitOnlyBySetCells) {
  // A ship of two rows, the lower one empty, above the wall. Only the empty row is level with the wall.
  const Mask ship = *Mask::fromRows({"####", "    "});
  const FixedBox wall = boxAt(0, 0, 1000000, 1);
  const Sweep along = sweep(ship, cells(-100, -1), cells(2000000, -1));
  EXPECT_TRUE(along.firstTouch(wall));
  EXPECT_EQ(along.firstShare(&ship, wall, nullptr), std::nullopt);
  // The ship sinks by one cell on the way, so its upper row is level with the wall at the end.
  const Sweep sinking = sweep(ship, cells(0, -1), cells(900000, 0));
  EXPECT_EQ(sinking.firstShare(&ship, wall, nullptr), (Moment{1, 1}));
  // The wall moves up instead of the ship down.
  const Sweep rising(boxAt(0, 0, 1000000, 1), cells(-900000, 0), cells(0, -1));
  EXPECT_EQ(rising.firstShare(nullptr, boxAt(0, -1, 4, 2), &ship),
            (Moment{1, static_cast<std::uint64_t>(kFixedOne)}));
}

// ---- The largest distances and speeds.

// Expects that `base`, at the origin and at all ends of the world, gives results that differ only by the
// offset.
void expectSameEverywhere(const Move& base, const FixedBox& other, Masks masks = {}) {
  const Sweep here = base.sweep();
  for (const Fixed x : {-kFar + fromCells(3000000), Fixed{0}, kFar - fromCells(3000000)}) {
    for (const Fixed y : {-kFar + fromCells(3000000), Fixed{0}, kFar - fromCells(3000000)}) {
      const FixedVector offset = {x, y};
      const Sweep there(base.box, base.from + offset, base.to + offset);
      const FixedBox other_there = translate(other, offset);
      const std::optional<Moment> touch = here.firstTouch(other);
      EXPECT_EQ(there.firstTouch(other_there), touch);
      EXPECT_EQ(there.firstShare(masks.p_own, other_there, masks.p_others),
                here.firstShare(masks.p_own, other, masks.p_others));
      EXPECT_EQ(there.closesGap(other_there), here.closesGap(other));
      EXPECT_EQ(there.movesOutOf(other_there), here.movesOutOf(other));
      const Moment moment = touch.value_or(Moment{1, 3});
      EXPECT_EQ(there.before(moment), here.before(moment) + offset);
    }
  }
}

TEST(FarAndFast, ResultsDoNotDependOnDistanceFromOrigin) {
  const Mask mask = *Mask::fromRows({"#  #", " ## ", "#  #"});
  for (const double size : {0.0, 1.0, 10000.0, 1000000.0}) {
    for (const double speed : {1.0, 15.0, 1000000.0}) {
      for (const double slope : {0.0, 0.001, -0.37, 1.0}) {
        const FixedBox box = {cells(-size / 2, -size / 2), cells(size, size)};
        const Move move = {box, cells(0.25, 0.75), cells(0.25 + speed, 0.75 + speed * slope)};
        for (const double x : {-3.0, 0.0, 5.0, 400.0, 999999.0}) {
          expectSameEverywhere(move, {cells(x, x * slope), cells(1, 3)}, {nullptr, &mask});
          expectSameEverywhere(move, {cells(x, 0), cells(10000, 0)}, {&mask, nullptr});
          expectSameEverywhere(move, {cells(x, 0.5), {}});
        }
      }
    }
  }
}

TEST(FarAndFast, SweepAcrossTheWholeWorldIsExact) {
  const FixedVector first = {-kFar, -kFar};
  const FixedVector last = {kFar, kFar};
  for (const bool is_back : {false, true}) {
    const Sweep sweep = is_back ? Sweep(kCharacter, last, first) : Sweep(kCharacter, first, last);
    const FixedVector target = is_back ? first : last;
    const Fixed unit = is_back ? -1 : 1;
    // An Object in the middle is hit after half of the path, less one cell.
    const FixedBox middle = translate(kCharacter, {});
    const auto way = static_cast<std::uint64_t>(kFar) * 2;
    const Moment touch = {static_cast<std::uint64_t>(kFar - kFixedOne), way};
    EXPECT_EQ(sweep.firstTouch(middle), touch);
    EXPECT_EQ(sweep.before(touch), (FixedVector{-unit * (kFixedOne + 1), -unit * (kFixedOne + 1)}));
    EXPECT_TRUE(sweep.closesGap(middle));
    EXPECT_FALSE(sweep.movesOutOf(middle));
    // An Object at the target is hit one cell before the end of the path.
    EXPECT_EQ(sweep.firstTouch(translate(kCharacter, target)), (Moment{way - kFixedOne, way}));
    const FixedBox beyond = translate(kCharacter, target + FixedVector{unit * kFixedOne, unit * kFixedOne});
    EXPECT_EQ(sweep.firstTouch(beyond), (Moment{1, 1}));
    EXPECT_EQ(sweep.before({1, 1}), (FixedVector{target.x - unit, target.y - unit}));
    EXPECT_EQ(sweep.firstTouch(translate(beyond, {unit, 0})), std::nullopt);
    // The move leaves an Object that it touches at the start, which is not hit.
    const FixedBox behind = translate(kCharacter, is_back ? last : first);
    EXPECT_EQ(sweep.firstTouch(behind), std::nullopt);
    EXPECT_TRUE(sweep.movesOutOf(behind));
  }
}

TEST(FarAndFast, SlowAxisBesideTheFastestOneIsExact) {
  // x crosses the world while y moves three units. y becomes 1 exactly after a third of the path.
  const Sweep sweep({{}, {}}, {-kFar, 0}, {kFar, 3});
  const auto way = static_cast<std::uint64_t>(kFar) * 2;
  const std::uint64_t third = way / 3 + 1;  // `way` is not a multiple of 3
  const auto at = [](std::uint64_t steps) { return advance(-kFar, kFar, steps); };
  EXPECT_EQ(sweep.firstTouch({{at(third), 1}, {}}), (Moment{third, way}));
  EXPECT_EQ(sweep.firstTouch({{at(third - 1), 1}, {}}), (Moment{1, 3})) << "between two steps of x";
  EXPECT_EQ(sweep.firstTouch({{at(third - 2), 1}, {}}), std::nullopt);
  EXPECT_EQ(sweep.firstTouch({{at(third - 1), 0}, {}}), (Moment{third - 1, way}));
  EXPECT_EQ(sweep.before({1, 3}), (FixedVector{at(third - 1), 0}));
  EXPECT_EQ(sweep.before({third, way}), (FixedVector{at(third - 1), 1}));
  EXPECT_EQ(sweep.before({1, 1}), (FixedVector{at(way - 1), 2}));
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
