#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class MayMoveOut : public WorldTest {
 protected:
  MayMoveOut() {
    wall = new Probe("wall", &received, Vector(20, 10));
    wall->setBox(Box(Vector(-5, -5), 10, 10));
    a = new Probe("a", &received, Vector(23, 10));  // inside the wall, nearest to its right side
  }

  Probe* wall;
  Probe* a;
};

TEST_F(MayMoveOut, WithoutItAnInsideObjectCannotLeave) {
  for (const bool may_the_other : {false, true}) {
    wall->setMayMoveOut(may_the_other);  // has no effect: only the mover's setting counts
    EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), -1) << may_the_other;
    expectAt(*a, 23, 10);
  }
}

TEST_F(MayMoveOut, LeavesStepByStepAndBothGetTheEvent) {
  a->setMayMoveOut();
  EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "wall:df-collision"}));
  EXPECT_EQ(WM.moveObject(a, Vector(25, 10)), 0);
  EXPECT_EQ(WM.moveObject(a, Vector(26, 10)), 0);
  expectAt(*a, 26, 10);
}

TEST_F(MayMoveOut, DoesNotAllowMovingDeeper) {
  a->setMayMoveOut();
  EXPECT_EQ(WM.moveObject(a, Vector(22, 10)), -1);
  EXPECT_EQ(WM.moveObject(a, Vector(23, 11)), -1);  // remains equally deep, so it is blocked
  expectAt(*a, 23, 10);
}

TEST_F(MayMoveOut, DoesNotAllowEnteringAnotherObject) {
  a->setMayMoveOut();
  new Probe("b", &received, Vector(25, 10));
  EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), -1);
  expectAt(*a, 23, 10);
}

TEST_F(MayMoveOut, NoSoftObjectMayLeaveASoftOne) {
  wall->setSolidness(SOFT);
  a->setNoSoft();
  EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), -1);
  a->setMayMoveOut();
  EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), 0);
}

TEST_F(MayMoveOut, UpdateMovesTheObjectOut) {
  a->setMayMoveOut();
  a->setVelocity(Vector(0.5, 0));
  for (int i = 0; i < 10; ++i) WM.update();
  expectAt(*a, 28, 10);
}

TEST_F(MayMoveOut, SweptObjectLeavesAndStopsAtNextWall) {
  a->setSwept();
  a->setMayMoveOut();
  new Probe("next", &received, Vector(40, 10));
  EXPECT_EQ(WM.moveObject(a, Vector(24, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "wall:df-collision"}));  // they still touch at the end
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(a->getPosition().y(), 10);
  EXPECT_NEAR(a->getPosition().x(), 39, 1e-9);
}

TEST_F(MayMoveOut, SweptObjectMovingDeeperIsBlockedAtOnce) {
  a->setSwept();
  a->setMayMoveOut();
  EXPECT_EQ(WM.moveObject(a, Vector(19, 10)), -1);
  expectAt(*a, 23, 10);
}

}  // namespace
}  // namespace df::test
