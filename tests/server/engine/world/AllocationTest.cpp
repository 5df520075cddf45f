// Checks that a tick allocates no heap memory once the world has run for a while.
#include <gtest/gtest.h>

#include "engine/events/EventOut.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "tests/support/AllocationCount.h"

namespace df::test {
namespace {

class Bouncer : public Object {
 public:
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      const Vector v = getVelocity();
      if (p_c->getObject1() == this) setVelocity(Vector(-v.x(), -v.y()));
    } else if (p_e->getType() == OUT_EVENT) {
      setPosition(Vector(40, 12));
    }
    return 1;
  }
};

std::uint64_t allocationsOf(bool swept, bool precise, bool events) {
  World world;
  const World::Scope scope(world);
  world.log().setSink([](const std::string&) {});
  WM.setSweptCollisions(swept);
  for (int i = 0; i < 300; ++i) {
    auto* p_o = new Bouncer;
    p_o->setPosition(Vector(i % 40 * 2, i / 40 * 3));
    p_o->setVelocity(Vector((i * 37 % 19 - 9) / 8.0, (i * 23 % 17 - 8) / 16.0));
    p_o->setSolidness(i % 10 == 0 ? SPECTRAL : i % 3 == 0 ? SOFT : HARD);
    if (i % 7 == 0) p_o->setBox(Box(Vector(-2, -1), 4, 2));
    if (precise && i % 2 == 0) p_o->setPrecise();
    if (events) p_o->setRestContacts();
  }
  for (int tick = 0; tick < 300; ++tick) WM.update();
  const std::uint64_t before = naiad::test::allocationsSoFar();
  for (int tick = 0; tick < 100; ++tick) WM.update();
  const std::uint64_t during = naiad::test::allocationsSoFar() - before;
  world.shutDown();
  return during;
}

TEST(Allocation, WarmWorldMovesAndSweepsWithoutAllocating) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  EXPECT_EQ(allocationsOf(false, false, false), 0u);
  EXPECT_EQ(allocationsOf(true, false, false), 0u) << "sweeps";
  EXPECT_EQ(allocationsOf(false, true, false), 0u) << "masks";
  EXPECT_EQ(allocationsOf(true, true, true), 0u) << "and contacts at rest";
}

}  // namespace
}  // namespace df::test
