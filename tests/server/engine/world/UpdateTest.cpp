#include "engine/events/EventStep.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Update : public WorldTest {
 protected:
  Probe* make(const std::string& name, double x, double y, Vector velocity = {}) {
    auto* p = new Probe(name, &received, Vector(x, y));
    p->setVelocity(velocity);
    return p;
  }
};

TEST_F(Update, MovesEachObjectByItsVelocityOnce) {
  Probe* a = make("a", 10, 10, Vector(0.25, -2));
  WM.update();
  expectAt(*a, 10.25, 8);
  EXPECT_EQ(world.getStepCount(), 0);
}

TEST_F(Update, PositionChangesBeforeVelocity) {
  Probe* a = make("a", 10, 10);
  a->setAcceleration(Vector(0.125, 0));
  const double expected[] = {10, 10.125, 10.375, 10.75};
  for (const double x : expected) {
    WM.update();
    expectAt(*a, x, 10);
  }
  EXPECT_EQ(a->getVelocity(), Vector(0.5, 0));
  EXPECT_EQ(a->getSpeed(), 0.5f);
  EXPECT_EQ(a->getDirection(), Vector(1, 0));
}

TEST_F(Update, BlockedMoverStillAccelerates) {
  make("floor", 10, 11);
  Probe* a = make("a", 10, 9.5, Vector(0, 1));
  a->setAcceleration(Vector(0, 0.5));
  WM.update();
  expectAt(*a, 10, 9.5);
  EXPECT_EQ(a->getVelocity(), Vector(0, 1.5));
}

TEST_F(Update, VelocityNeverLeavesItsRange) {
  Probe* a = make("a", 0, 0, Vector(kMaxVelocityCells, 0));
  a->setAcceleration(Vector(1, 0));
  WM.update();
  EXPECT_EQ(a->getVelocity(), Vector(kMaxVelocityCells, 0));
}

TEST_F(Update, ObjectStopsAtTheNumberLimit) {
  Probe* a = make("a", 1999999999, 0, Vector(10, 0));
  WM.update();
  WM.update();
  expectAt(*a, 1999999999, 0);
  EXPECT_EQ(world.log().refusals(), 2u);
  EXPECT_EQ(logged("the next position"), 1);
}

TEST_F(Update, EarlierMovesAreSeenByLaterOnes) {
  Probe* a = make("a", 10, 10, Vector(5, 0));
  Probe* b = make("b", 16, 10, Vector(5, 0));
  WM.update();  // a hits b, which has not moved yet
  expectAt(*a, 10, 10);
  expectAt(*b, 21, 10);
  WM.update();
  expectAt(*a, 15, 10);
}

TEST_F(Update, HeadOnMoversRaiseFourEvents) {
  make("a", 10, 10, Vector(1, 0));
  make("b", 11.5, 10, Vector(-1, 0));
  WM.update();
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision", "b:df-collision", "a:df-collision"}));
}

TEST_F(Update, PushingAWallSendsAPairEveryTick) {
  make("wall", 12, 10);
  make("a", 10.75, 10, Vector(1, 0));
  for (int i = 0; i < 3; ++i) WM.update();
  EXPECT_EQ(received.size(), 6u);
}

TEST_F(Update, ObjectsAtRestRaiseNoEvents) {
  make("a", 10, 10);
  make("b", 10, 10);
  WM.update();
  EXPECT_TRUE(received.empty());
}

TEST_F(Update, InactiveObjectIsNotMoved) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  a->setActive(false);
  WM.update();
  expectAt(*a, 10, 10);
}

TEST_F(Update, ActivityIsReadAtTheObjectsTurn) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  Probe* b = make("b", 20, 10, Vector(1, 0));
  make("wall", 11, 10)->setSolidness(SOFT);
  a->on_event = [&](Probe&, const Event&) { b->setActive(false); };
  WM.update();
  expectAt(*b, 20, 10);
}

TEST_F(Update, ChangedVelocityTakesEffectNextTick) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  make("wall", 11, 10)->setSolidness(SOFT);
  a->on_event = [](Probe& self, const Event&) { self.setVelocity(Vector(0, 1)); };
  WM.update();
  expectAt(*a, 11, 10);
  EXPECT_EQ(a->getVelocity(), Vector(0, 1));
}

TEST_F(Update, ObjectReinsertedDuringUpdateLosesItsTurn) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  Probe* b = make("b", 20, 10, Vector(1, 0));
  make("wall", 11, 10)->setSolidness(SOFT);
  a->on_event = [&](Probe&, const Event&) {
    WM.removeObject(b);
    WM.insertObject(b);  // back in the world, but last: its first move is in the next update
  };
  WM.update();
  expectAt(*b, 20, 10);
  a->on_event = nullptr;
  WM.update();
  expectAt(*b, 21, 10);
}

TEST_F(Update, ObjectBornInHandlerCollidesNowMovesNextTick) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  make("wall", 11, 10)->setSolidness(SOFT);
  Probe* c = make("c", 30, 10, Vector(1, 0));
  Probe* born = nullptr;
  a->on_event = [&](Probe&, const Event&) {
    if (born == nullptr) born = make("born", 32, 10, Vector(3, 0));
  };
  WM.update();
  ASSERT_NE(born, nullptr);
  expectAt(*born, 32, 10);
  expectAt(*c, 30, 10);  // stopped by `born`
  WM.update();
  expectAt(*born, 35, 10);
}

TEST_F(Update, ObjectBornInStepMovesNowWithoutStepEvent) {
  Probe* a = make("a", 10, 10);
  a->registerInterest(STEP_EVENT);
  Probe* born = nullptr;
  a->on_event = [&](Probe&, const Event&) {
    if (born != nullptr) return;
    born = make("born", 32, 10, Vector(3, 0));
    born->registerInterest(STEP_EVENT);
  };
  GM.tick();
  expectAt(*born, 35, 10);
  EXPECT_EQ(received, (Received{"a:df-step"}));
  GM.tick();
  EXPECT_EQ(received, (Received{"a:df-step", "a:df-step", "born:df-step"}));
}

TEST_F(Update, MarkedObjectStaysActiveUntilTheUpdateEnds) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  Probe* b = make("b", 11.5, 10);
  WM.markForDelete(a);
  EXPECT_EQ(WM.markForDelete(a), 0);  // the second mark has no effect
  WM.markForDelete(b);
  WM.update();
  EXPECT_EQ(received, (Received{"a:df-collision", "b:df-collision"}));
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(Update, DeletionsHappenInMarkOrder) {
  struct Dying : Object {
    Dying(std::string n, Received* list) : name(std::move(n)), p_list(list) {}
    ~Dying() override { p_list->push_back(name); }
    std::string name;
    Received* p_list;
  };
  Object* a = new Dying("a", &received);
  Object* b = new Dying("b", &received);
  WM.markForDelete(b);
  WM.markForDelete(a);
  WM.markForDelete(b);
  WM.update();
  WM.update();
  EXPECT_EQ(received, (Received{"b", "a"}));
}

TEST_F(Update, StaleDeletionMarkDoesNotHitASuccessor) {
  Probe* a = make("a", 10, 10);
  WM.markForDelete(a);
  delete a;
  make("b", 10, 10);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 1);
}

TEST_F(Update, NestedUpdateDoesNothing) {
  Probe* a = make("a", 10, 10, Vector(1, 0));
  make("wall", 11, 10)->setSolidness(SOFT);
  a->on_event = [](Probe&, const Event&) {
    WM.update();
    GM.tick();
  };
  WM.update();
  expectAt(*a, 11, 10);
  EXPECT_EQ(world.getStepCount(), 0);
}

TEST_F(Update, SevenHundredBirthsAndDeathsInOneTick) {
  std::vector<Object*> crowd;
  for (int i = 0; i < 700; ++i) crowd.push_back(make("old", i % 80, i / 80));
  Probe* a = make("a", 10, 20, Vector(1, 0));
  make("wall", 11, 20)->setSolidness(SOFT);
  int births = 0;
  a->on_event = [&](Probe&, const Event&) {
    for (int i = 0; i < 700; ++i) {
      if (i % 2 == 0) {
        delete crowd[i];
      } else {
        WM.markForDelete(crowd[i]);
      }
      make("new", 200 + 3 * (i % 80), 3 * (i / 80), Vector(0, 50));
      ++births;
    }
  };
  WM.update();
  EXPECT_EQ(births, 700);
  EXPECT_EQ(world.store().countInWorld(), 702);
  EXPECT_EQ(WM.objectsOfType("new").getCount(), 700);
  EXPECT_EQ(WM.objectsOfType("old").getCount(), 0);
  a->on_event = nullptr;
  WM.update();
  expectAt(*WM.objectsOfType("new")[699], 200 + 3 * (699 % 80), 3 * (699 / 80) + 50);
}

TEST_F(Update, HandlersMayDeleteEveryObjectRepeatedly) {
  for (int round = 0; round < 200; ++round) {
    Probe* a = make("a", 10, 20, Vector(1, 0));
    Probe* wall = make("wall", 11, 20);
    a->on_event = [wall](Probe& self, const Event&) {
      delete wall;
      delete &self;
    };
    WM.update();
  }
  EXPECT_EQ(world.store().countInWorld(), 0);
  EXPECT_TRUE(WM.getAllObjects(true).isEmpty());
}

}  // namespace
}  // namespace df::test
