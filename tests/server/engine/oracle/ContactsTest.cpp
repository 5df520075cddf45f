// Tests the oracle's precise pairs, rest contacts, moving out of walls and findFree() against sentences of
// docs/collisions.md.
#include "BookWorld.h"

namespace oracle {
namespace {

using ContactsTest = BookWorld;

// "Two characters side by side touch by their boxes but share no cell".
TEST_F(ContactsTest, PreciseCharactersPassSideBySide) {
  Object* p_o = make(10, 10);
  make(15, 11);
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), -1);
  p_o->precise = true;
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), 0);
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10.5)), -1);  // 10.5 lies in the cell of 11
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10.5) - FixedVector{0, 1}), 0);
}

// "If either Object is precise, the masks are compared".
TEST_F(ContactsTest, OnePreciseObjectMakesThePairPrecise) {
  Object* p_o = make(10, 10);
  make(15, 11)->precise = true;
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), 0);
}

// "the masks are compared after the boxes": a ship is hit where it is drawn.
TEST_F(ContactsTest, AShotPassesThroughAHole) {
  Object* p_ship = make(20, 10);
  p_ship->box = boxOf(6, 3);
  p_ship->mask = {"  /\\", " /##\\ ", "/_||_\\"};
  p_ship->precise = true;
  Object* p_shot = make(10, 10);
  const auto isHit = [&](double x, double y) { return !m_world.getCollisions(p_shot, cells(x, y)).empty(); };
  // The box's corner is (17,8.5): its first character is drawn in cell (18,9).
  EXPECT_FALSE(isHit(18, 9));
  EXPECT_FALSE(isHit(19, 9));
  EXPECT_TRUE(isHit(20, 9));
  EXPECT_TRUE(isHit(21, 9));
  EXPECT_FALSE(isHit(22, 9));  // the row is too short
  EXPECT_FALSE(isHit(18, 10));
  EXPECT_TRUE(isHit(19, 10));
  EXPECT_TRUE(isHit(18, 11));
  EXPECT_TRUE(isHit(23, 11));
  EXPECT_FALSE(isHit(23, 12));
}

// "An Object without a mask counts as full: max(1, ⌈w⌉) by max(1, ⌈h⌉) characters."
TEST_F(ContactsTest, AFullMaskHasAtLeastOneCharacter) {
  Object* p_point = make(20, 10);
  p_point->box = {};
  p_point->precise = true;
  Object* p_shot = make(10, 10);
  p_shot->box = {{}, cells(2.25, 1)};
  // The point is drawn in cell (21,11), the shot's three characters from the cell after its corner on.
  EXPECT_TRUE(m_world.getCollisions(p_shot, cells(20, 10)).size() == 1);
  EXPECT_TRUE(m_world.getCollisions(p_shot, cells(18, 10)).size() == 1);
  EXPECT_TRUE(m_world.getCollisions(p_shot, cells(18, 9)).empty());
}

// "the time is the first at which the masks share a cell and the boxes touch"
TEST_F(ContactsTest, SweptShotStopsAtTheEndOfAHole) {
  Object* p_mouth = make(20, 10);
  p_mouth->box = boxOf(5, 3);
  p_mouth->mask = {"#####", "    #", "#####"};
  p_mouth->precise = true;
  Object* p_shot = make(10, 10);
  p_shot->swept = true;
  EXPECT_EQ(m_world.moveObject(p_shot, cells(30, 10)), -1);
  // The throat is in cell 22; the shot enters that cell at 21.5.
  EXPECT_EQ(p_shot->position, cells(21.5, 10) - (FixedVector{1, 0}));
}

// "it may be met later in the move, after the two have separated".
TEST_F(ContactsTest, ObjectLeavingOneToothMayHitTheNext) {
  Object* p_comb = make(20, 10);
  p_comb->box = boxOf(9, 1);
  p_comb->mask = {"#   #   #"};  // in cells 16, 20 and 24
  p_comb->precise = true;
  Object* p_o = make(16, 10);
  p_o->swept = true;
  // The box distance is largest above and below, so moving along the comb never closes the gap.
  EXPECT_EQ(m_world.moveObject(p_o, cells(18, 10)), 0);  // between two teeth
  EXPECT_EQ(m_world.moveObject(p_o, cells(16, 10)), -1);
  p_o->position = cells(16, 10);
  m_events.clear();
  EXPECT_EQ(m_world.moveObject(p_o, cells(26, 10)), -1);
  EXPECT_EQ(m_events, "1:1>0 0:1>0 ");
  EXPECT_EQ(p_o->position, cells(19.5, 10) - (FixedVector{1, 0}));
  p_o->position = cells(16, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(24, 10)), -1);  // ends in a tooth: the contact at the start counts
  EXPECT_EQ(p_o->position, cells(16, 10));
}

// An Object with rest contacts collides in every update as if it had moved to its own position.
TEST_F(ContactsTest, RestContactsAreSentOnRequest) {
  Object* p_floor = make(10, 10);
  make(11, 10);
  m_world.update();
  EXPECT_EQ(m_events, "");
  p_floor->rest_contacts = true;
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(m_where, cells(10, 10));
  p_floor->swept = true;
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 0:0>1 1:0>1 ");
}

// "A HARD Object placed inside another can then leave it. Both still get events."
TEST_F(ContactsTest, MoveOutObjectLeavesAWallStepByStep) {
  for (const bool swept : {false, true}) {
    Object* p_o = make(12, swept ? 18 : 6);
    p_o->swept = swept;
    make(10, swept ? 18 : 6)->box = boxOf(6, 6);
    const FixedVector start = p_o->position;
    const FixedVector step = cells(0.5, 0);
    EXPECT_EQ(m_world.moveObject(p_o, start + step), -1);
    p_o->may_move_out = true;
    EXPECT_EQ(m_world.moveObject(p_o, start - step), -1);  // deeper
    EXPECT_EQ(m_world.moveObject(p_o, start), -1);         // as deep as before
    m_events.clear();
    EXPECT_EQ(m_world.moveObject(p_o, start + step), 0);
    EXPECT_EQ(m_events, swept ? "2:2>3 3:2>3 " : "0:0>1 1:0>1 ");
    EXPECT_EQ(p_o->position, start + step);
    EXPECT_EQ(m_world.counters().moved_out, swept ? 2 : 1);
  }
}

// "a pair that touches at the start of the move": other pairs block as always.
TEST_F(ContactsTest, MovingOutDoesNotAllowEnteringAnother) {
  Object* p_o = make(10, 10);
  p_o->may_move_out = true;
  make(9.5, 10);
  make(12, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(11, 10)), -1);
  EXPECT_EQ(m_world.moveObject(p_o, cells(10.5, 10)), 0);
}

// "the position nearest to `near`, in whole cells from it"; of equally near positions, the one with the least
// y, then the least x.
TEST_F(ContactsTest, FindFreeReturnsTheNearestPosition) {
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(10.5, 10.5));
  make(10.5, 10.5);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(10.5, 8.5));  // one cell away touches
  make(10.5, 8.5);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(8.5, 10.5));
  make(40, 0.5, df::SPECTRAL);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(40, 0.25)), cells(40, 1.25));  // the edge of the world
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(-3.25, 30.5)), cells(0.75, 23.5));
  EXPECT_EQ(m_world.findFree(boxOf(80, 24), cells(40, 12)), std::nullopt);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(-2000, 10)), std::nullopt);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(0, 0)), cells(1, 1));
}

}  // namespace
}  // namespace oracle
