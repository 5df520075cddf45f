// Tests the ends of the ranges: Objects that are far away, very fast, very large or very many.
#include "tests/server/engine/Probe.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

using Extremes = WorldTest;

class Reacting : public Object {
 public:
  explicit Reacting(std::function<void(Reacting&, const EventCollision&)> reaction = {})
      : m_reaction(std::move(reaction)) {}
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() != COLLISION_EVENT) return 0;
    ++collisions;
    if (m_reaction) m_reaction(*this, *static_cast<const EventCollision*>(p_e));
    return 1;
  }
  int collisions = 0;

 private:
  std::function<void(Reacting&, const EventCollision&)> m_reaction;
};

/// Returns the positions of a small crowd, relative to `origin`, tick by tick, and counts its collisions.
std::vector<FixedVector> pathAround(Vector origin, bool swept, int& collisions) {
  World world;
  const World::Scope scope(world);
  world.log().setSink([](const std::string&) {});
  WM.setSweptCollisions(swept);
  std::vector<Reacting*> crowd;
  const auto turn = [](Reacting& self, const EventCollision& c) {
    const Vector v = self.getVelocity();
    if (c.getObject1() == &self) self.setVelocity(Vector(-v.y(), v.x()));
  };
  for (int i = 0; i < 40; ++i) {
    auto* p_o = new Reacting(turn);
    p_o->setPosition(origin + Vector(i % 8 * 2.5, i / 8 * 1.75));
    p_o->setVelocity(Vector((i * 37 % 19 - 9) / 8.0, (i * 23 % 17 - 8) / 16.0));
    if (i % 5 == 0) p_o->setBox(Box(Vector(-1.5, -1), 3, 2));
    if (i % 3 == 0) p_o->setSolidness(SOFT);
    crowd.push_back(p_o);
  }
  std::vector<FixedVector> path;
  for (int tick = 0; tick < 60; ++tick) {
    WM.update();
    for (const Reacting* p_o : crowd)
      path.push_back(world.store().position(p_o->key().slot) - *toFixed(origin));
  }
  for (const Reacting* p_o : crowd) collisions += p_o->collisions;
  world.shutDown();
  return path;
}

// Reads positions from the store, because a double cannot hold 2^-32 cells at 2e9.
TEST_F(Extremes, PathsAtTwoBillionCellsMatchTheOrigin) {
  for (const bool swept : {false, true}) {
    int here = 0;
    const std::vector<FixedVector> path = pathAround(Vector(0, 0), swept, here);
    EXPECT_GT(here, 100);
    for (const double x : {1.99999e9, -1.99999e9, 63.0, 1e6}) {
      int there = 0;
      EXPECT_TRUE(pathAround(Vector(x, -x / 2), swept, there) == path) << x << (swept ? " swept" : "");
      EXPECT_EQ(there, here);
    }
  }
}

TEST_F(Extremes, InvalidNumbersAreRefusedAndTheWorldContinues) {
  auto* p_o = new Reacting;
  p_o->setVelocity(Vector(1, 0));
  auto* p_other = new Reacting;
  p_other->setPosition(Vector(5, 5));
  p_other->setVelocity(Vector(0.5, 0));
  std::uint64_t refused = 0;
  for (const double x : {kNan, kInfinity, -kInfinity, 1e30}) {
    for (const Vector v : {Vector(x, 0), Vector(0, x)}) {
      EXPECT_EQ(p_o->setPosition(v), -1);
      EXPECT_EQ(p_o->setVelocity(v), -1);
      EXPECT_EQ(p_o->setAcceleration(v), -1);
      EXPECT_EQ(p_o->setDirection(v), -1);
      EXPECT_EQ(WM.moveObject(p_o, v), -1);
      EXPECT_EQ(p_o->setBox(Box(v, 1, 1)), -1);
      EXPECT_FALSE(WM.findFree(Box(Vector(), 1, 1), v).has_value());
      refused += 7;
    }
    EXPECT_EQ(p_o->setBox(Box(Vector(), x, 1)), -1);
    EXPECT_EQ(p_o->setSpeed(x), -1);
    refused += 2;
  }
  EXPECT_EQ(world.log().refusals(), refused);
  WM.update();
  EXPECT_EQ(p_o->getPosition(), Vector(1, 0));
  EXPECT_EQ(p_other->getPosition(), Vector(5.5, 5));
}

TEST_F(Extremes, AMillionObjectsLoadAndStep) {
  WM.setBoundary(Box(Vector(0, 0), 4000, 4000));
  for (int i = 0; i < 1000000; ++i) {
    auto* p_o = new PlacedObject(Vector(i % 2000 * 2, i / 2000 * 4));
    p_o->setVelocity(Vector(0.25, i % 2 == 0 ? 0.25 : -0.25));
  }
  for (int tick = 0; tick < 3; ++tick) WM.update();
  EXPECT_EQ(world.store().countInWorld(), 1000000);
}

}  // namespace
}  // namespace df::test
