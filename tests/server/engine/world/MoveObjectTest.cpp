#include <algorithm>
#include <optional>
#include <stdexcept>

#include "SweptWorld.h"

namespace df::test {
namespace {

using MoveObject = SweptWorld;

TEST_F(MoveObject, FreeMoverMoves) {
  Probe* a = make("a", 10, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(12.5, 9)), 0);
  expectAt(*a, 12.5, 9);
  EXPECT_TRUE(received.empty());
}

TEST_F(MoveObject, BlockedMoverKeepsItsPosition) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 15, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(14.5, 10)), -1);
  expectAt(*a, 10, 10);
  expectAt(*b, 15, 10);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
}

TEST_F(MoveObject, TouchingEdgesCollideButATinyGapDoesNot) {
  Probe* a = make("a", 10, 10);
  make("b", 15, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(14, 11)), -1);
  EXPECT_EQ(WM.moveObject(a, Vector(14 - 1.0 / 1024 / 1024, 11)), 0);
}

TEST_F(MoveObject, SoftPairsOverlapAndBothGetEvents) {
  for (const auto& [mover, other] : {std::pair{SOFT, SOFT}, std::pair{SOFT, HARD}, std::pair{HARD, SOFT}}) {
    received.clear();
    Probe* a = make("a", 10, 10, mover);
    Probe* b = make("b", 15, 10, other);
    EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), 0);
    expectAt(*a, 15, 10);
    EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
    delete a;
    delete b;
  }
}

TEST_F(MoveObject, SpectralObjectsNeverCollide) {
  Probe* a = make("a", 10, 10, SPECTRAL);
  Probe* b = make("b", 15, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), 0);
  EXPECT_EQ(WM.moveObject(b, Vector(15.5, 10)), 0);
  EXPECT_TRUE(received.empty());
}

TEST_F(MoveObject, NoSoftMoverIsBlockedBySoft) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 15, 10, SOFT);
  a->setNoSoft();
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
  // Only the mover's setting counts.
  EXPECT_EQ(WM.moveObject(b, Vector(10, 10)), 0);
}

TEST_F(MoveObject, AllOverlappedGetEventsInOrderDespiteABlocker) {
  make("b", 15, 10);
  make("c", 15.5, 10, SOFT);
  Probe* a = make("a", 10, 10);
  make("d", 16, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(15.5, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision", "a:df-collision", "c:df-collision",
                                "a:df-collision", "d:df-collision"}));
}

TEST_F(MoveObject, CollisionEventNamesMoverOtherAndTarget) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 15, 10);
  int seen = 0;
  const auto check = [&](Probe&, const Event& e) {
    const auto& c = dynamic_cast<const EventCollision&>(e);
    EXPECT_EQ(c.getObject1(), a);
    EXPECT_EQ(c.getObject2(), b);
    EXPECT_EQ(c.getPosition(), Vector(14.25, 10));
    ++seen;
  };
  a->on_event = check;
  b->on_event = check;
  WM.moveObject(a, Vector(14.25, 10));
  EXPECT_EQ(seen, 2);
}

TEST_F(MoveObject, HandlersDecideHowTheMoveEnds) {
  const Vector target(15, 10);
  const auto setAside = [](Probe& a, Probe&) { a.setPosition(Vector(40, 10)); };
  const Received both = {"a:df-collision", "b:df-collision"}, only_a = {"a:df-collision"};
  const struct {
    const char* p_name;
    Solidness mover;
    bool is_movers;  // true: the mover handles the event, else the other
    std::function<void(Probe& a, Probe& b)> handle;
    int result;
    std::optional<Vector> end;  // nullopt: the mover is deleted
    Received received;
  } kCases[] = {
      {"softens the pair", HARD, false, [](Probe&, Probe& b) { b.setSolidness(SOFT); }, 0, target, both},
      {"hardens the pair", SOFT, true, [](Probe& a, Probe&) { a.setSolidness(HARD); }, -1, Vector(10, 10),
       both},
      {"sets the position of a soft mover", SOFT, true, setAside, 0, target, both},
      {"sets the position of a blocked mover", HARD, true, setAside, -1, Vector(40, 10), both},
      {"deletes the other", HARD, true, [](Probe&, Probe& b) { delete &b; }, 0, target, only_a},
      {"deletes the mover", HARD, true, [](Probe& a, Probe&) { delete &a; }, -1, {}, only_a},
      {"marks the mover", SOFT, true, [](Probe& a, Probe&) { WM.markForDelete(&a); }, 0, target, both},
      {"makes a newcomer at the target", SOFT, false, [&](Probe&, Probe&) { make("late", 15, 10, SOFT); }, 0,
       target, both},
      {"makes the other inactive", SOFT, true, [](Probe&, Probe& b) { b.setActive(false); }, 0, target,
       only_a},
  };
  for (const auto& its : kCases) {
    SCOPED_TRACE(its.p_name);
    world.shutDown();
    received.clear();
    Probe* a = make("a", 10, 10, its.mover);
    Probe* b = make("b", 15, 10);
    (its.is_movers ? a : b)->on_event = [&](Probe&, const Event&) { its.handle(*a, *b); };
    EXPECT_EQ(WM.moveObject(a, target), its.result);
    if (its.end) expectAt(*a, its.end->x(), its.end->y());
    EXPECT_EQ(received, its.received);
  }
}

TEST_F(MoveObject, RuleIsAppliedRightAfterEachPairsHandlers) {
  make("b", 15, 10);
  Probe* c = make("c", 15, 10, SOFT);
  Probe* a = make("a", 10, 10);
  // The pair with b was HARD against HARD; the change in c's handler is too late.
  c->on_event = [&](Probe&, const Event&) { a->setSolidness(SPECTRAL); };
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), -1);
}

TEST_F(MoveObject, ObjectDeletedByAHandlerIsSkipped) {
  Probe* b = make("b", 15, 10);
  Probe* c = make("c", 15, 10);
  Probe* a = make("a", 10, 10, SOFT);
  b->on_event = [&](Probe&, const Event&) { delete std::exchange(c, nullptr); };
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
}

TEST_F(MoveObject, DeletingTheMoverInAHandlerEndsTheMove) {
  make("b", 15, 10);
  Probe* c = make("c", 15, 10);
  Probe* a = make("a", 10, 10);
  make("d", 15, 10);
  c->on_event = [&](Probe&, const Event&) { delete a; };
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision", "a:df-collision", "c:df-collision"}));
}

TEST_F(MoveObject, InactiveObjectNeitherCollidesNorGetsEvents) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 15, 10);
  b->setActive(false);
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), 0);
  EXPECT_TRUE(received.empty());
  b->setActive(true);
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), -1);
}

TEST_F(MoveObject, MovingToTheSamePositionTestsCollisions) {
  Probe* a = make("a", 10, 10, SOFT);
  make("b", 10, 10);
  EXPECT_EQ(WM.moveObject(a, a->getPosition()), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
}

TEST_F(MoveObject, MovesNestedDeeperThan32AreRefused) {
  Probe* a = make("a", 10, 10, SOFT);
  Probe* b = make("b", 11, 10, SOFT);
  int depth = 0;
  int deepest = 0;
  int refused = 0;
  a->on_event = [&](Probe& self, const Event&) {
    deepest = std::max(deepest, ++depth);
    if (WM.moveObject(&self, Vector(11, 10)) == -1) ++refused;
    --depth;
  };
  EXPECT_EQ(WM.moveObject(a, Vector(11, 10)), 0);
  EXPECT_EQ(deepest, 32);
  EXPECT_EQ(refused, 1);
  expectAt(*a, 11, 10);
  expectAt(*b, 11, 10);
}

TEST_F(MoveObject, OutEventIsSentOnExitNotOnReentry) {
  Probe* a = make("a", 78, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(79.99, 10)), 0);
  EXPECT_TRUE(received.empty());
  EXPECT_EQ(WM.moveObject(a, Vector(80, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-out"}));
  WM.moveObject(a, Vector(90, 10));
  WM.moveObject(a, Vector(70, 10));
  EXPECT_EQ(received.size(), 1u);
  WM.moveObject(a, Vector(70, -0.001));
  EXPECT_EQ(received.size(), 2u);
}

TEST_F(MoveObject, PlacingAnObjectOutsideSendsNoOutEvent) {
  Probe* a = make("a", -5, 10);
  WM.moveObject(a, Vector(-6, 10));
  a->setPosition(Vector(5, 5));
  a->setPosition(Vector(-5, 5));
  EXPECT_TRUE(received.empty());
}

TEST_F(MoveObject, OutEventIsJudgedFromThePositionAfterHandlers) {
  Probe* a = make("a", 78, 10, SOFT);
  make("b", 82, 10);
  a->on_event = [](Probe& self, const Event& e) {
    if (isCollision(e)) self.setPosition(Vector(-10, 10));  // already outside: no out event
  };
  EXPECT_EQ(WM.moveObject(a, Vector(81.5, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
}

TEST_F(MoveObject, OutHandlerSeesThePositionOutsideAndMayDelete) {
  Probe* a = make("a", 79, 10, SPECTRAL);
  double x = 0;
  a->on_event = [&](Probe& self, const Event&) {
    x = self.getPosition().x();
    delete &self;
  };
  EXPECT_EQ(WM.moveObject(a, Vector(85, 10)), 0);
  EXPECT_EQ(x, 85);
}

TEST_F(MoveObject, OutEventUsesTheBoundarysCorner) {
  ASSERT_EQ(WM.setBoundary(Box(Vector(100, 100), 10, 10)), 0);
  Probe* a = make("a", 100, 100);
  WM.moveObject(a, Vector(99.9, 100));
  EXPECT_EQ(received, (Received{"a:df-out"}));
}

TEST_F(MoveObject, TargetOutOfRangeIsRefused) {
  Probe* a = make("a", 10, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WM.moveObject(a, Vector(nan, 10)), -1);
  EXPECT_EQ(WM.moveObject(a, Vector(3e9, 10)), -1);
  EXPECT_EQ(WM.moveObject(nullptr, Vector()), -1);
  expectAt(*a, 10, 10);
  EXPECT_EQ(world.log().refusals(), 2u);
}

TEST_F(MoveObject, ThrowingHandlerRemovesOnlyItsObject) {
  Probe* a = make("a", 10, 10, SOFT);
  Probe* b = make("b", 15, 10);
  b->on_event = [](Probe&, const Event&) { throw std::runtime_error("oops"); };
  EXPECT_EQ(WM.moveObject(a, Vector(15, 10)), 0);
  EXPECT_FALSE(world.events().isRunning());
  EXPECT_FALSE(b->isActive());
  EXPECT_EQ(logged("oops"), 1);
  WM.update();
  EXPECT_EQ(WM.getAllObjects(true).getCount(), 1);
}

TEST_F(MoveObject, BigBoxesCollideAtTheirEdges) {
  Probe* wall = make("wall", 0, 20);
  ASSERT_EQ(wall->setBox(Box(Vector(0, 0), 200000, 1)), 0);
  Probe* a = make("a", 150000, 10);
  EXPECT_EQ(WM.moveObject(a, Vector(150000, 19.5)), -1);
  EXPECT_EQ(WM.moveObject(a, Vector(150000, 19.25)), 0);
  EXPECT_EQ(WM.moveObject(wall, Vector(0, 18)), -1);
}

}  // namespace
}  // namespace df::test
