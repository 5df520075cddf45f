#include <algorithm>

#include "SweptWorld.h"

namespace df::test {
namespace {

class SweptHandlers : public SweptWorld {};

TEST_F(SweptHandlers, HardenedObjectBlocksAndLaterOnesGetNoEvent) {
  Probe* b = make("b", 15, 10, SOFT);
  make("also", 15, 10, SOFT);
  make("c", 20, 10, SOFT);
  Probe* a = makeSwept("a", 10, 10);
  b->on_event = [](Probe& self, const Event&) { self.setSolidness(HARD); };
  EXPECT_EQ(WM.moveObject(a, Vector(30, 10)), -1);
  EXPECT_EQ(received, pairs("a", {"b", "also"}));
  expectAt(*a, 14 - kUnit, 10);
}

TEST_F(SweptHandlers, MoverContinuesWhenTheGlassIsDeleted) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* glass = make("glass", 20, 10);
  make("near", 22, 10, SOFT);
  make("wall", 30, 10);
  glass->on_event = [](Probe& self, const Event&) { delete &self; };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(received, pairs("a", {"glass", "near", "wall"}));
  expectAt(*a, 29 - kUnit, 10);
}

TEST_F(SweptHandlers, MoverPassesGlassTurnedSoftWithOneEvent) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* glass = make("glass", 20, 10);
  make("soft", 15, 10, SOFT);
  glass->on_event = [](Probe& self, const Event&) { self.setSolidness(SOFT); };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), 0);
  EXPECT_EQ(received, pairs("a", {"soft", "glass"}));
  expectAt(*a, 50, 10);
}

TEST_F(SweptHandlers, BreaksAllGlassesOnItsPath) {
  Probe* a = makeSwept("a", 10, 10);
  for (int i = 0; i < 60; ++i) {
    make("glass", 20 + 0.5 * i, 10)->on_event = [](Probe& self, const Event&) { delete &self; };
  }
  EXPECT_EQ(WM.moveObject(a, Vector(70, 10)), 0);
  EXPECT_EQ(received.size(), 120u);
  expectAt(*a, 70, 10);
}

TEST_F(SweptHandlers, RemainingPathSeesChangesMadeByHandlers) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* glass = make("glass", 20, 10);
  Probe* aside = make("aside", 30, 20);
  Probe* away = make("away", 25, 10);
  glass->on_event = [&](Probe& self, const Event&) {
    aside->setPosition(Vector(40, 10));
    away->setPosition(Vector(25, 20));
    make("new", 35, 10, SOFT);
    make("behind", 15, 10);  // behind the mover
    delete &self;
  };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(received, pairs("a", {"glass", "new", "aside"}));
  expectAt(*a, 39 - kUnit, 10);
}

TEST_F(SweptHandlers, ObjectAlreadyHitIsNotHitAgainLater) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* glass = make("glass", 20, 10);
  glass->on_event = [](Probe& self, const Event&) { self.setPosition(Vector(40, 10)); };
  EXPECT_EQ(WM.moveObject(a, Vector(60, 10)), -1);  // decided at once: HARD onto HARD
  expectAt(*a, 19 - kUnit, 10);
  glass->setPosition(Vector(30, 10));
  glass->on_event = [](Probe& self, const Event&) {
    self.setPosition(Vector(40, 10));
    self.setSolidness(SOFT);
  };
  received.clear();
  EXPECT_EQ(WM.moveObject(a, Vector(60, 10)), 0);
  EXPECT_EQ(received, pairs("a", {"glass"}));
}

TEST_F(SweptHandlers, MoverTurnedSpectralPassesToTheTarget) {
  Probe* a = makeSwept("a", 10, 10);
  make("glass", 20, 10);
  make("wall", 30, 10);
  a->on_event = [](Probe& self, const Event&) { self.setSolidness(SPECTRAL); };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), 0);
  EXPECT_EQ(received, pairs("a", {"glass"}));
  expectAt(*a, 50, 10);
}

TEST_F(SweptHandlers, GrownMoverUsesItsNewBoxAfterwards) {
  Probe* a = makeSwept("a", 10, 10);
  Probe* glass = make("glass", 20, 10);
  make("wall", 30, 14);
  glass->on_event = [&](Probe& self, const Event&) {
    a->setBox(Box(Vector(-4, -4), 8, 8));
    delete &self;
  };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  expectAt(*a, 25.5 - kUnit, 10);
}

TEST_F(SweptHandlers, MoverStopsAfterAThousandReplacedGlasses) {
  Probe* a = makeSwept("a", 10, 10);
  make("glass", 20, 10);
  int glasses = 0;
  a->on_event = [&](Probe&, const Event& e) {
    ++glasses;
    delete dynamic_cast<const EventCollision&>(e).getObject2();
    make("glass", 20, 10);
  };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(glasses, 1000);
  expectAt(*a, 19 - kUnit, 10);
}

TEST_F(SweptHandlers, DeletedMoverEndsTheMove) {
  Probe* a = makeSwept("a", 10, 10);
  make("b", 20, 10, SOFT);
  make("c", 30, 10, SOFT);
  a->on_event = [](Probe& self, const Event&) { delete &self; };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  EXPECT_EQ(received, (Received{"a:df-collision"}));
}

TEST_F(SweptHandlers, BlockedMoverStaysWhereAHandlerPutIt) {
  Probe* a = makeSwept("a", 10, 10);
  make("b", 20, 10);
  a->on_event = [](Probe& self, const Event&) { self.setPosition(Vector(5, 5)); };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  expectAt(*a, 5, 5);
}

TEST_F(SweptHandlers, SweptSettingIsFixedDuringTheMove) {
  Probe* a = makeSwept("a", 10, 10);
  make("glass", 20, 10, SOFT);
  make("wall", 30, 10);
  a->on_event = [](Probe& self, const Event&) { self.setSwept(false); };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), -1);
  expectAt(*a, 29 - kUnit, 10);
}

TEST_F(SweptHandlers, NestedMovesHaveSeparateHitLists) {
  Probe* a = makeSwept("a", 10, 10, SOFT);
  Probe* b = makeSwept("b", 20, 10, SOFT);
  make("on both ways", 30, 10, SOFT);
  b->on_event = [](Probe& self, const Event&) {
    self.on_event = nullptr;
    WM.moveObject(&self, Vector(40, 10));
  };
  EXPECT_EQ(WM.moveObject(a, Vector(50, 10)), 0);
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision", "b:df-collision",
                                "on both ways:df-collision", "a:df-collision", "on both ways:df-collision"}));
}

TEST_F(SweptHandlers, MovesNestedDeeperThan32AreRefused) {
  Probe* a = makeSwept("a", 10, 10, SOFT);
  make("b", 20, 10, SOFT);
  int deepest = 0;
  int depth = 0;
  a->on_event = [&](Probe& self, const Event&) {
    deepest = std::max(deepest, ++depth);
    WM.moveObject(&self, Vector(30, 10));
    --depth;
  };
  EXPECT_EQ(WM.moveObject(a, Vector(30, 10)), 0);
  EXPECT_EQ(deepest, 32);
}

}  // namespace
}  // namespace df::test
