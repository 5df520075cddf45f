#include "SweptWorld.h"

namespace df::test {
namespace {

class SweptMoves : public SweptWorld {};

TEST_F(SweptMoves, ArrowDoesNotFlyThroughTheWindow) {
  makeWall("window", 40);
  for (const bool swept : {false, true}) {
    Probe* arrow = make("arrow", 2, 10);
    arrow->setBox(Box(Vector(-2, -0.5), 4, 1));
    arrow->setSwept(swept);
    arrow->setVelocity(Vector(15, 0));
    for (int i = 0; i < 4; ++i) WM.update();
    expectAt(*arrow, swept ? 37.5 - kUnit : 62, 10);
    delete arrow;
  }
}

TEST_F(SweptMoves, BlockedMoverStopsOneUnitBeforeTheContact) {
  Probe* a = makeSwept("a", 10, 10);
  make("b", 20, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  expectAt(*a, 19 - kUnit, 10);
  EXPECT_EQ(received, pairs("a", {"b"}));
  EXPECT_TRUE(WM.getCollisions(a, a->getPosition()).isEmpty());
}

TEST_F(SweptMoves, DiagonalMoverStopsWithBothCoordinatesBeforeContact) {
  Probe* a = makeSwept("a", 10, 10);
  make("b", 21, 15);
  EXPECT_EQ(WM.moveObject(a, Vector(30, 20)), -1);  // touches at x = 20, half-way
  expectAt(*a, 20 - kUnit, 15 - kUnit);
}

TEST_F(SweptMoves, MoveEndingInATouchStopsOneUnitBefore) {
  Probe* a = makeSwept("a", 10, 10);
  make("b", 20, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(19, 10)), -1);
  expectAt(*a, 19 - kUnit, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(19 - kUnit, 9)), 0);
}

TEST_F(SweptMoves, EventHasThePositionJustBeforeTheContact) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* b = make("b", 20, 10);
  int seen = 0;
  const auto check = [&](Probe&, const Event& e) {
    const auto& c = dynamic_cast<const EventCollision&>(e);
    EXPECT_EQ(c.getObject1(), a);
    EXPECT_EQ(c.getObject2(), b);
    EXPECT_EQ(c.getPosition(), Vector(19 - kUnit, 10));
    expectAt(*a, 10, 10);
    ++seen;
  };
  a->on_event = check;
  b->on_event = check;
  WM.moveObject(a, Vector(50, 10));
  EXPECT_EQ(seen, 2);
}

TEST_F(SweptMoves, SoftObjectsGetEventsInTimeThenCreationOrder) {
  make("far", 40, 10, SOFT);
  make("second", 20, 10.5, SOFT);
  make("third", 20, 9.5, SOFT);
  make("first", 15, 10, SOFT);
  make("beside", 20, 12, SOFT);
  Probe* a = makeSwept("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(60, 10)), 0);
  expectAt(*a, 60, 10);
  EXPECT_EQ(received, pairs("a", {"first", "second", "third", "far"}));
}

TEST_F(SweptMoves, ObjectsBehindTheBlockerGetNoEvent) {
  make("behind", 30, 10, SOFT);
  makeWall("wall", 25);
  make("at once", 25, 10, SOFT);
  make("before", 15, 10, SOFT);
  Probe* a = makeSwept("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(60, 10)), -1);
  EXPECT_EQ(received, pairs("a", {"before", "wall", "at once"}));
  expectAt(*a, 24 - kUnit, 10);
}

TEST_F(SweptMoves, NoSoftMoverIsBlockedOnThePath) {
  Probe* a = makeSwept("a", 10, 10);
  a->setNoSoft();
  make("b", 20, 10, SOFT);
  EXPECT_EQ(WM.moveObject(a, Vector(30, 10)), -1);
  expectAt(*a, 19 - kUnit, 10);
}

TEST_F(SweptMoves, MaySlideAlongAWallAndLeaveIt) {
  WM.setBoundary(Box(Vector(), 80, 80));
  makeWall("wall", 20);
  Probe* a = makeSwept("a", 10, 10);
  WM.moveObject(a, Vector(30, 10));
  received.clear();
  EXPECT_EQ(WM.moveObject(a, Vector(19 - kUnit, 15)), 0);
  expectAt(*a, 19 - kUnit, 15);
  a->setPosition(Vector(19, 15));  // touching
  EXPECT_EQ(WM.moveObject(a, Vector(15, 15)), 0);
  expectAt(*a, 15, 15);
  a->setPosition(Vector(19, 20));
  EXPECT_EQ(WM.moveObject(a, Vector(19, 30)), 0);  // beyond the wall's end
  expectAt(*a, 19, 30);
  EXPECT_TRUE(received.empty());
}

TEST_F(SweptMoves, TouchingMoverMovingCloserIsBlockedAtOnce) {
  make("b", 11, 10);
  Probe* a = makeSwept("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(20, 10)), -1);
  expectAt(*a, 10, 10);
  EXPECT_EQ(received, pairs("a", {"b"}));
}

TEST_F(SweptMoves, OtherObjectsCountAtTheirCurrentPosition) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* b = make("b", 30, 10);
  a->setVelocity(Vector(40, 0));
  b->setVelocity(Vector(0, 10));
  WM.update();  // b has not moved away yet
  expectAt(*a, 29 - kUnit, 10);
  expectAt(*b, 30, 20);
  WM.update();
  expectAt(*a, 69 - kUnit, 10);
}

TEST_F(SweptMoves, MoversCrossingInOneTickCollide) {
  WM.setSweptCollisions();
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 20, 10);
  a->setVelocity(Vector(12, 0));
  b->setVelocity(Vector(-12, 0));
  WM.update();
  expectAt(*a, 19 - kUnit, 10);
  expectAt(*b, 20, 10);
}

TEST_F(SweptMoves, WorldSettingSweepsAllMoves) {
  make("wall", 20, 10);
  Probe* a = make("a", 10, 10);
  EXPECT_FALSE(WM.getSweptCollisions());
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), 0);
  a->setPosition(Vector(10, 10));
  WM.setSweptCollisions();
  EXPECT_TRUE(WM.getSweptCollisions());
  a->setVelocity(Vector(40, 0));
  WM.update();
  expectAt(*a, 19 - kUnit, 10);
  WM.setSweptCollisions(false);
  WM.update();
  expectAt(*a, 59 - kUnit, 10);
}

TEST_F(SweptMoves, BlockedMoverRetriesEachUpdateAndStaysBlocked) {
  Probe* a = makeSwept("a", 10, 10);
  make("wall", 20, 10);
  a->setVelocity(Vector(5, 0));
  for (int i = 0; i < 4; ++i) WM.update();
  expectAt(*a, 19 - kUnit, 10);
  EXPECT_EQ(a->getVelocity(), Vector(5, 0));
  EXPECT_EQ(received.size(), 6u);
}

TEST_F(SweptMoves, MoverIsStoppedAtAnySpeed) {
  make("wall", 500000, 10);
  for (const double speed : {0.001, 1.0, 7.0, 128.0, 5000.0, 1e6}) {
    for (const double sign : {1.0, -1.0}) {
      const double x = 500000 - sign * (1 + speed / 3);
      Probe* a = makeSwept("a", x, 10);
      a->setVelocity(Vector(sign * speed, 0));
      WM.update();
      EXPECT_EQ(a->getPosition(), Vector(500000 - sign * (1 + kUnit), 10)) << speed;
      delete a;
    }
  }
}

TEST_F(SweptMoves, FindsASingleCharacterOnAMillionCellPath) {
  for (int i = 0; i < 50; ++i) make("away", 20000 * i, 500);
  make("wall", 999900, 999900);
  Probe* a = makeSwept("a", 0, 0);
  EXPECT_EQ(WM.moveObject(a, Vector(1e6, 1e6)), -1);
  expectAt(*a, 999899 - kUnit, 999899 - kUnit);
}

TEST_F(SweptMoves, MoverIsStoppedAtTheNumberLimit) {
  const double far = 1999999999;
  Probe* a = makeSwept("a", far - 40, -far);
  Probe* b = make("b", far, -far);
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -far)), -1);
  // A double has no higher precision at such positions.
  EXPECT_NEAR(a->getPosition().x(), far - 1, 1e-6);
  delete b;
  a->setPosition(Vector(-2e9, 2e9));
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -2e9)), 0);
  EXPECT_EQ(WM.moveObject(a, Vector(-2e9, 2e9)), 0);
  make("middle", 0, 0);
  EXPECT_EQ(WM.moveObject(a, Vector(2e9, -2e9)), -1);
  expectAt(*a, -1 - kUnit, 1 + kUnit);
}

TEST_F(SweptMoves, OutEventIsSentOnceAtTheFinalPosition) {
  Probe* a = makeSwept("a", 70, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(100, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-out"}));
  make("beyond", 90, 10);
  a->setPosition(Vector(70, 10));
  received.clear();
  double x = 0;
  a->on_event = [&](Probe& self, const Event& e) {
    if (!isCollision(e)) x = self.getPosition().x();
  };
  EXPECT_EQ(WM.moveObject(a, Vector(100, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "beyond:df-collision", "a:df-out"}));
  EXPECT_EQ(x, 89 - kUnit);
}

TEST_F(SweptMoves, ViewFollowsToTheStopPosition) {
  WM.setBoundary(Box(Vector(), 400, 24));
  makeWall("wall", 201);
  Probe* a = makeSwept("a", 40, 10);
  WM.setViewFollowing(a);
  WM.moveObject(a, Vector(300, 10));
  const double left = WM.getView().getCorner().x();
  EXPECT_GT(left, 100);
  EXPECT_LT(left, 200);
}

}  // namespace
}  // namespace df::test
