// Jointed bodies through WM.update(). The bounds are the targets of the laboratory (docs/physics/lab.md).
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyJoints : public BodyScene {};

Body* point(Vector place, double mass = 1) {
  auto* p_point = new Body;
  p_point->setSolidness(SPECTRAL);
  p_point->setPosition(place);
  p_point->setMass(mass);
  return p_point;
}

TEST_F(BodyJoints, SwingingSpringKeepsItsEnergy) {
  PM.setGravity(perSecondSquared(Vector(0, 10)));
  Body* p_body = point(Vector(2, 0));
  PM.addSpring(nullptr, p_body, Vector(), Vector(2, 0), perSecondSquared(100)).setLength(2);
  for (int tick = 0; tick < 300; ++tick) {
    ticks(1);
    const Vector at = p_body->getPosition(), v = speedOf(p_body);
    const double stretch = std::hypot(at.x(), at.y()) - 2;
    ASSERT_NEAR((v.x() * v.x() + v.y() * v.y()) / 2 - 10 * at.y() + 50 * stretch * stretch, 0, 1e-8) << tick;
  }
}

TEST_F(BodyJoints, JointsCanBeRemovedAndAddedAgain) {
  PM.setGravity(perSecondSquared(Vector(0, 10)));
  Body* p_bob = point(Vector(0, 2));
  Joint rod = PM.addDistance(nullptr, p_bob, Vector(), Vector(0, 2));
  ticks(30);
  EXPECT_NEAR(p_bob->getPosition().y(), 2, 1e-12);
  EXPECT_NEAR(rod.getForce().y(), -perSecondSquared(10), 1e-12);
  rod.remove();
  ticks(30);
  EXPECT_NEAR(p_bob->getPosition().y(), 7, 1e-9);
  rod = PM.addDistance(nullptr, p_bob, Vector(0, 6), p_bob->getPosition());
  p_bob->setVelocity(Vector());
  ticks(30);
  EXPECT_NEAR(p_bob->getPosition().y(), 7, 1e-9);
}

TEST_F(BodyJoints, JointsBreakAboveTheirBreakForce) {
  PM.setGravity(perSecondSquared(Vector(0, 10)));
  Body* p_bob = point(Vector(0, 2), 3);
  Joint rod = PM.addDistance(nullptr, p_bob, Vector(), Vector(0, 2));
  rod.setBreakForce(perSecondSquared(31));
  ticks(30);
  EXPECT_TRUE(rod.exists());
  rod.setBreakForce(perSecondSquared(29));
  ticks(1);
  EXPECT_FALSE(rod.exists());
  ticks(30);
  EXPECT_GT(p_bob->getPosition().y(), 6);
}

TEST_F(BodyJoints, MouseJointDragsItsBodyToTheTarget) {
  Body* p_crate = point(Vector(0, 0), 4);
  Joint mouse = PM.addMouse(p_crate, Vector(0, 0), 1e6);
  mouse.setTarget(Vector(5, -3));
  ticks(60);
  EXPECT_NEAR(p_crate->getPosition().x(), 5, 1e-6);
  EXPECT_NEAR(p_crate->getPosition().y(), -3, 1e-6);
  mouse.remove();
  ticks(1);
  EXPECT_EQ(PM.getJointCount(), 0);
}

TEST_F(BodyJoints, AMotorTurnsAWheelOnItsAxle) {
  Body* p_wheel = point(Vector(3, 3));
  p_wheel->setCircle(1);
  p_wheel->setTurning();
  PM.addHinge(nullptr, p_wheel, Vector(3, 3));
  PM.addMotor(nullptr, p_wheel, 0.1, 1e3);
  ticks(10);
  EXPECT_NEAR(p_wheel->getSpin(), 0.1, 1e-9);
  EXPECT_NEAR(p_wheel->getAngle(), 1, 0.06);
  EXPECT_NEAR(p_wheel->getPosition().x(), 3, 1e-12);
}

TEST_F(BodyJoints, InactiveBodyHoldsTheBodyJointedToIt) {
  PM.setGravity(perSecondSquared(Vector(0, 10)));
  Body* p_hook = point(Vector(0, 0));
  Body* p_bob = point(Vector(0, 2));
  PM.addDistance(p_hook, p_bob);
  p_hook->setActive(false);
  ticks(30);
  EXPECT_NEAR(p_bob->getPosition().y(), 2, 1e-9);
  p_hook->setActive(true);
  ticks(30);
  EXPECT_NEAR(p_bob->getPosition().y() - p_hook->getPosition().y(), 2, 1e-9);
  EXPECT_GT(p_hook->getPosition().y(), 4);
}

TEST_F(BodyJoints, TorqueTurnsAFreeBody) {
  Body* p_wheel = point(Vector());
  p_wheel->setCircle(2);
  p_wheel->setTurning();
  p_wheel->applyTorque(0.02);
  ticks(1);
  EXPECT_NEAR(p_wheel->getSpin(), 0.01, 1e-15);
  ticks(9);
  EXPECT_NEAR(p_wheel->getAngle(), 0.095, 1e-14);
}

}  // namespace
}  // namespace df::test
