#include <algorithm>
#include <memory>

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

TEST_F(Update, AMillionObjectsLoadAndStep) {
  WM.setBoundary(Box(Vector(0, 0), 4000, 4000));
  for (int i = 0; i < 1000000; ++i) {
    auto* p_o = new PlacedObject(Vector(i % 2000 * 2, i / 2000 * 4));
    p_o->setVelocity(Vector(0.25, i % 2 == 0 ? 0.25 : -0.25));
  }
  for (int tick = 0; tick < 3; ++tick) WM.update();
  EXPECT_EQ(world.store().countInWorld(), 1000000);
}

TEST_F(Update, FreedSlotIsReusedOnlyAfterARest) {
  auto first = std::make_unique<Object>();
  const ObjectKey dead = first->key();
  first.reset();
  for (std::uint64_t i = 1; i < WorldStore::kSlotReuseDelay; ++i) WM.update();
  const Object early;
  EXPECT_NE(early.key().slot, dead.slot);
  WM.update();
  const Object late;
  EXPECT_EQ(late.key().slot, dead.slot);
  EXPECT_GT(late.key().generation, dead.generation);
}

TEST_F(Update, ChurnDoesNotGrowTheStore) {
  std::uint32_t highest = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    auto* p_o = new Object;
    highest = std::max(highest, p_o->key().slot);
    WM.markForDelete(p_o);
    WM.update();
  }
  EXPECT_LE(highest, WorldStore::kSlotReuseDelay + 1);
}

}  // namespace
}  // namespace df::test
