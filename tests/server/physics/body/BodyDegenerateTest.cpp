// Thin shapes, joints without length, springs that are too stiff, and incompatible masses.

#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

using BodyDegenerate = BodyScene;

// A sheet 1/50 high falls on a floor and rests there.
TEST_F(BodyDegenerate, ThinPolygonRestsOnAFloor) {
  PM.setGravity(Vector(0, 0.01));
  wall(Vector(0, 5), Vector(500, 5));
  auto* p_sheet = new Body;
  p_sheet->setTurning();
  ASSERT_EQ(p_sheet->setPolygon({Vector(0, 0), Vector(4, 0), Vector(4, 0.02), Vector(0, 0.02)}), 0);
  EXPECT_GT(p_sheet->getInertia(), 0);
  p_sheet->setPosition(Vector(100, -4));
  ticks(400);
  EXPECT_LT(p_sheet->getVelocity().getMagnitude(), 1e-3);
  EXPECT_NEAR(p_sheet->getPosition().y(), -0.01, 1e-3);
  EXPECT_FALSE(p_sheet->isFrozen());
}

// With two bodies in one place, a rod or rope of length zero is refused, and so is a slider without a
// direction. Joints that may have length zero (spring, hinge, weld, slider) hold the bodies.
TEST_F(BodyDegenerate, ZeroLengthJointsAreRefusedOrHold) {
  PM.setGravity(Vector(0, 0.01));
  const auto here = Vector(3, 4);
  for (int kind = 0; kind < 8; ++kind) {
    SCOPED_TRACE(kind);
    Body* p_a = ball(here, Vector());
    Body* p_b = ball(here, Vector());
    Joint joint;
    if (kind == 0) joint = PM.addDistance(p_a, p_b);
    if (kind == 1) joint = PM.addRope(p_a, p_b);
    if (kind == 2) joint = PM.addSpring(p_a, p_b, 1);
    if (kind == 3) joint = PM.addSpring(p_a, p_b, 1e10, 1e10);
    if (kind == 4) joint = PM.addHinge(p_a, p_b, here);
    if (kind == 5) joint = PM.addWeld(p_a, p_b, here);
    if (kind == 6) joint = PM.addSlider(p_a, p_b, here, Vector(1, 0));
    if (kind == 7) joint = PM.addSlider(p_a, p_b, here, Vector(0, 0));
    EXPECT_EQ(joint.exists(), kind >= 2 && kind <= 6);
    if (joint.exists()) {
      p_a->applyImpulse(Vector(0.1, 0.05));
      ticks(50);
      EXPECT_FALSE(p_a->isFrozen() || p_b->isFrozen());
      const double middle = (p_a->getPosition().y() + p_b->getPosition().y()) / 2;
      EXPECT_NEAR(middle, here.y() + 50 * 0.025 + 0.5 * 0.01 * 50 * 50, 1e-6);
      EXPECT_LT(std::fabs(p_a->getPosition().y() - p_b->getPosition().y()), 0.05);
    }
    delete p_a;
    delete p_b;
  }
  EXPECT_EQ(PM.getJointCount(), 0);
}

// Springs of stiffness 1e10 keep their length for bodies of any mass.
TEST_F(BodyDegenerate, StiffSpringsKeepTheirLength) {
  PM.setGravity(Vector(0, 0.01));
  for (const double mass : {1e-3, 1.0, 1e3}) {
    for (const double damping : {0.0, 1e5, 1e10}) {
      Body* p_a = ball(Vector(0, 0), Vector());
      Body* p_b = ball(Vector(5, 0), Vector());
      p_b->setMass(mass);
      ASSERT_TRUE(PM.addSpring(p_a, p_b, 1e10, damping).exists());
      p_b->applyImpulse(Vector(0, 0.1 * mass));
      for (int i = 0; i < 100; ++i) {
        ticks(1);
        ASSERT_FALSE(p_a->isFrozen() || p_b->isFrozen());
        ASSERT_NEAR((p_b->getPosition() - p_a->getPosition()).getMagnitude(), 5, 0.01)
            << mass << ' ' << damping;
        ASSERT_LT(p_a->getVelocity().getMagnitude(), 2);
      }
      delete p_a;
      delete p_b;
    }
  }
}

// One of the bodies has a million times the mass: in compounds, on hinges and with soft bodies, above or
// below.
TEST_F(BodyDegenerate, MassRatiosOfAMillionStayBounded) {
  PM.setGravity(Vector(0, 0.01));
  wall(Vector(0, 5), Vector(500, 5));
  for (const bool is_heavy_above : {true, false}) {
    const double low = is_heavy_above ? 1 : 1e6, high = is_heavy_above ? 1e6 : 1;
    std::vector<Object*> all;
    for (int i = 0; i < 3; ++i) {
      auto* p_body = new Body;
      p_body->setTurning();
      p_body->setBoxShape(2, 1);
      p_body->addBoxShape(1, 0.5, Vector(0, 0.75));
      p_body->setMass(i == 2 ? high : low);
      p_body->setPosition(Vector(0, -2 - 2.5 * i));
      all.push_back(p_body);
    }
    Body* p_before = nullptr;
    for (int i = 0; i < 4; ++i) {
      Body* p_link = turningCrate(Vector(101.0 + 2 * i, -14), Vector(1, 0.2), i == 3 ? high : low);
      PM.addHinge(p_before, p_link, Vector(100.0 + 2 * i, -14));
      p_before = p_link;
      all.push_back(p_link);
    }
    all.push_back(new Blob(Vector(-50, -3), 2, low));
    all.push_back(new Blob(Vector(-50, -8), 2, high));
    all.push_back(new Beam(Vector(-80, -2), Vector(-74, -2), low));
    all.push_back(new Beam(Vector(-80, -4), Vector(-74, -4), high));
    for (int i = 0; i < 200; ++i) {
      ticks(1);
      for (const Object* p_object : all) {
        // A fall from 40 gives a speed of 0.9. A light link at the end of heavy links is a whip, and may be
        // faster.
        ASSERT_LT(p_object->getVelocity().getMagnitude(), 1.8) << p_object->getType() << ' ' << i;
        ASSERT_LT(p_object->getPosition().y(), 2) << p_object->getType() << ' ' << i;
      }
    }
    for (Object* p_object : all) delete p_object;
  }
  EXPECT_EQ(PM.getQuarantineCount(), 0u);
}

}  // namespace
}  // namespace df::test
