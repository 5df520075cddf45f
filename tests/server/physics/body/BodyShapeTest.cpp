#include <numbers>

#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df {
namespace {

using BodyShapes = test::PhysicsWorld;

TEST_F(BodyShapes, BoxEnclosesTheShape) {
  auto* p_body = new Body;
  ASSERT_EQ(p_body->setCircle(2), 0);
  EXPECT_EQ(p_body->getBox().getHorizontal(), 4);
  EXPECT_EQ(p_body->getBox().getVertical(), 2);  // a cell is twice as high as wide
  ASSERT_EQ(p_body->setBoxShape(6, 1), 0);
  EXPECT_EQ(p_body->getBox().getHorizontal(), 6);
  EXPECT_EQ(p_body->getBox().getVertical(), 1);
  p_body->setAngle(std::numbers::pi / 2);
  EXPECT_NEAR(p_body->getBox().getHorizontal(), 2, 1e-9);
  EXPECT_NEAR(p_body->getBox().getVertical(), 3, 1e-9);
}

TEST_F(BodyShapes, InertiaMatchesTheShape) {
  PM.setAspect(1);
  auto* p_body = new Body;
  p_body->setMass(3);
  EXPECT_NEAR(p_body->getInertia(), 3 * (1 + 1) / 12.0, 1e-15);
  p_body->setCircle(2);
  EXPECT_NEAR(p_body->getInertia(), 3 * 2 * 2 / 2.0, 1e-14);
  p_body->setPolygon({Vector(0, 0), Vector(4, 0), Vector(4, 2), Vector(0, 2)});
  EXPECT_NEAR(p_body->getInertia(), 3 * (16 + 4) / 12.0, 1e-14);
  EXPECT_NEAR(p_body->getBox().getCorner().x(), -2, 1e-9);  // the position is the middle
}

TEST_F(BodyShapes, PartsMakeACompound) {
  PM.setAspect(1);
  auto* p_body = new Body;
  ASSERT_EQ(p_body->setBoxShape(2, 2), 0);
  ASSERT_EQ(p_body->addBoxShape(2, 2, Vector(2, 0)), 0);
  EXPECT_EQ(p_body->getShapes().size(), 2u);
  EXPECT_NEAR(p_body->getInertia(), (16 + 4) / 12.0, 1e-14);
  EXPECT_NEAR(p_body->getBox().getCorner().x(), -2, 1e-9);
  ASSERT_EQ(p_body->setBoxShape(), 0);
  EXPECT_TRUE(p_body->getShapes().empty());
}

TEST_F(BodyShapes, InvalidShapesAndNumbersAreRefused) {
  auto* p_body = new Body;
  for (const double bad : {kNan, -1.0, 0.0, 1e31}) {
    EXPECT_EQ(p_body->setCircle(bad), -1) << bad;
    EXPECT_EQ(p_body->setBoxShape(bad, 1), -1) << bad;
    EXPECT_EQ(p_body->addCircle(bad, Vector()), -1) << bad;
  }
  EXPECT_EQ(p_body->setPolygon({Vector(0, 0), Vector(1, 0)}), -1);
  EXPECT_EQ(p_body->setPolygon({Vector(0, 0), Vector(1, 0), Vector(kNan, 1)}), -1);
  EXPECT_EQ(p_body->setRestitution(1.1), -1);
  EXPECT_EQ(p_body->setFriction(-0.1), -1);
  EXPECT_EQ(p_body->setAngle(kNan), -1);
  EXPECT_EQ(p_body->setSpin(kNan), -1);
  EXPECT_EQ(p_body->applyTorque(kNan), -1);
  EXPECT_EQ(p_body->applyImpulseAt(Vector(kNan, 0), Vector()), -1);
  EXPECT_EQ(PM.setObstacleFriction(kNan), -1);
  EXPECT_TRUE(p_body->getShapes().empty());
  EXPECT_EQ(p_body->getFriction(), 0.5);
  EXPECT_GT(world.log().refusals(), 18u);
}

TEST_F(BodyShapes, OffCentreImpulseSpinsOnlyTurningBodies) {
  PM.setAspect(1);
  auto* p_body = new Body;
  p_body->setMass(2);
  p_body->setCircle(1);
  p_body->applyImpulseAt(Vector(0, 4), Vector(1, 0));
  EXPECT_EQ(p_body->getSpin(), 0);
  p_body->setTurning();
  p_body->applyImpulseAt(Vector(0, -4), Vector(-1, 0));
  EXPECT_EQ(p_body->getVelocity(), Vector());
  EXPECT_NEAR(p_body->getSpin(), 4, 1e-15);
}

TEST_F(BodyShapes, JointsAreDeletedWithTheirBodies) {
  auto* p_a = new Body;
  auto* p_b = new Body;
  p_b->setPosition(Vector(3, 2));
  Joint rod = PM.addDistance(p_a, p_b);
  EXPECT_TRUE(rod.exists());
  EXPECT_NEAR(rod.getLength(), 5, 1e-15);
  Joint hinge = PM.addHinge(nullptr, p_a, Vector(1, 0));
  EXPECT_EQ(PM.getJointCount(), 2);
  EXPECT_EQ(rod.remove(), 0);
  EXPECT_EQ(rod.remove(), -1);
  Joint spring = PM.addSpring(p_a, p_b, 1);
  EXPECT_FALSE(rod.exists());  // the rod's joint does not exist, although its index is reused
  delete p_b;
  EXPECT_FALSE(spring.exists());
  EXPECT_TRUE(hinge.exists());
  EXPECT_EQ(PM.getJointCount(), 1);
}

TEST_F(BodyShapes, ImpossibleJointsAreNotCreated) {
  auto* p_body = new Body;
  EXPECT_FALSE(Joint().exists());
  EXPECT_FALSE(PM.addDistance(p_body, p_body).exists());
  EXPECT_FALSE(PM.addDistance(nullptr, nullptr).exists());
  EXPECT_FALSE(PM.addDistance(p_body, nullptr, Vector(1, 1), Vector(1, 1)).exists());
  EXPECT_FALSE(PM.addHinge(p_body, nullptr, Vector(kNan, 0)).exists());
  World other;
  Body* p_stranger = nullptr;
  {
    const World::Scope inside(other);
    p_stranger = new Body;
  }
  EXPECT_FALSE(PM.addDistance(p_body, p_stranger).exists());
  EXPECT_EQ(PM.getJointCount(), 0);
  other.shutDown();
}

}  // namespace
}  // namespace df
