#include "engine/world/Capture.h"
#include "physics/kits/Bridge.h"
#include "physics/kits/Obstacle.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

class Bridges : public PhysicsWorld {
 protected:
  Bridges() { PM.setGravity(Vector(0, 0.02)); }
};

TEST_F(Bridges, BridgeHangsBetweenItsEnds) {
  const std::vector<Body*> planks = makeBridge(Vector(10, 10), Vector(42, 12), 8);
  ASSERT_EQ(planks.size(), 8u);
  EXPECT_EQ(PM.getJointCount(), 9);
  for (std::size_t i = 0; i < planks.size(); ++i) {
    EXPECT_NEAR(planks[i]->getPosition().x(), 12 + 4.0 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(planks[i]->getPosition().y(), 10.125 + 0.25 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(planks[i]->getMass(), 1);
  }
  ticks(600);
  for (const Body* p_plank : planks) {
    EXPECT_GT(p_plank->getPosition().x(), 10);
    EXPECT_LT(p_plank->getPosition().x(), 42);
    EXPECT_LT(p_plank->getPosition().y(), 20);
  }
  EXPECT_NEAR(planks.front()->getPosition().x(), 12, 1);
  EXPECT_NEAR(planks.back()->getPosition().x(), 40, 1);
}

TEST_F(Bridges, CrateRestsOnTheBridge) {
  makeBridge(Vector(10, 10), Vector(42, 10), 8);
  Body* p_crate = turningCrate(Vector(26, 8), Vector(3, 1));
  p_crate->setFriction(0.8);
  ticks(600);
  EXPECT_GT(p_crate->getPosition().y(), 8);
  EXPECT_LT(p_crate->getPosition().y(), 18);
  EXPECT_NEAR(p_crate->getPosition().x(), 26, 4);
}

TEST_F(Bridges, InvalidBridgesAreNotBuilt) {
  EXPECT_TRUE(makeBridge(Vector(0, 0), Vector(10, 0), 0).empty());
  EXPECT_TRUE(makeBridge(Vector(0, 0), Vector(10, 0), -3).empty());
  EXPECT_TRUE(makeBridge(Vector(0, 0), Vector(10, 0), 100).empty());
  EXPECT_TRUE(makeBridge(Vector(10, 0), Vector(0, 0), 3).empty());
  EXPECT_TRUE(makeBridge(Vector(kNan, 0), Vector(0, 0), 3).empty());
  EXPECT_EQ(PM.getBodyCount(), 0);
}

TEST_F(Bridges, BodiesRestOnAnObstacle) {
  const auto* p_floor = new Obstacle(Vector(0, 20), 40, 2, '%', BLUE);
  const Body* p_crate = crate(Vector(20, 10), Vector(2, 1));
  ticks(300);
  EXPECT_NEAR(p_crate->getPosition().y() + 1, 19.5, 1e-6);
  EXPECT_EQ(p_floor->getPosition(), Vector(0, 20));
  const Canvas canvas = world.picture().render({});
  EXPECT_EQ(canvas.at(0, 20).ch, U'%');
  EXPECT_EQ(canvas.at(39, 21).ch, U'%');
  EXPECT_EQ(canvas.at(40, 20).ch, U' ');
  EXPECT_EQ(canvas.at(0, 22).ch, U' ');
}

}  // namespace
}  // namespace df::test
