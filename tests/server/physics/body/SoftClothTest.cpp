// Tests df::Cloth with different numbers of threads.
#include <algorithm>

#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"

namespace df {
namespace {

class SoftCloth : public test::PhysicsWorld {
 protected:
  SoftCloth() { PM.setGravity(Vector(0, 0.02)); }
};

TEST_F(SoftCloth, ThreadCountIsAsRequestedWithinLimits) {
  const Cloth usual(Vector(0, 0), 1000, 1000);
  EXPECT_EQ(usual.getColumns(), 25);
  EXPECT_EQ(usual.getRows(), 25);
  const Cloth fine(Vector(0, 0), 30, 20, 1, 5, 128, 40);
  EXPECT_EQ(fine.getColumns(), 128);
  EXPECT_EQ(fine.getRows(), 40);
  EXPECT_EQ(fine.getNodeCount(), 128 * 40);
  EXPECT_NEAR(fine.getNodePosition(fine.getNode(127, 39)).x(), 30, 1e-6);
  EXPECT_NEAR(fine.getNodePosition(fine.getNode(127, 39)).y(), 20, 1e-6);
  const auto before = world.log().refusals();
  const Cloth refused(Vector(0, 0), 30, 20, 1, 5, 129, 1);
  EXPECT_EQ(world.log().refusals(), before + 2);
  EXPECT_EQ(refused.getColumns(), 13);
}

TEST_F(SoftCloth, PinnedClothStretchesByAtMostFivePercent) {
  constexpr int kThreads = 100;
  auto* p_cloth = new Cloth(Vector(10, 5), 99, 49.5, 1, 5, kThreads, kThreads);
  p_cloth->pin(p_cloth->getNode(0, 0));
  p_cloth->pin(p_cloth->getNode(kThreads - 1, 0));
  const double mesh = PM.getAspect() * 0.5;
  for (int i = 0; i < 60; ++i) {
    world.tick();
    for (int k = 0; k + 1 < kThreads; ++k) {
      for (const int other : {p_cloth->getNode(k + 1, 0), p_cloth->getNode(k, 1)}) {
        const Vector apart =
            p_cloth->getNodePosition(other) - p_cloth->getNodePosition(p_cloth->getNode(k, 0));
        ASSERT_LE(std::hypot(apart.x(), PM.getAspect() * apart.y()), 1.05 * std::max(1.0, mesh))
            << i << " " << k;
      }
    }
  }
  EXPECT_EQ(p_cloth->getNodePosition(p_cloth->getNode(0, 0)), Vector(10, 5));
  EXPECT_FALSE(p_cloth->isFrozen());
}

TEST_F(SoftCloth, NodeForcesMoveTheWholeCloth) {
  auto* p_cloth = new Cloth(Vector(10, 5), 20, 10, 1, 5, 40, 40);
  PM.setGravity(Vector(0, 0));
  for (int i = 0; i < 10; ++i) {
    for (int node = 0; node < p_cloth->getNodeCount(); ++node) {
      p_cloth->applyForce(node, Vector(0.01 / p_cloth->getNodeCount(), 0));
    }
    world.tick();
  }
  EXPECT_NEAR(p_cloth->getVelocity().x(), 0.1, 0.02);
  world.tick();
  const double speed = p_cloth->getVelocity().x();
  EXPECT_LE(speed, 0.1);
}

}  // namespace
}  // namespace df
