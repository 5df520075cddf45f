// Uses every type that a public function of the physics takes or returns, with only the headers that a game
// has. tests/install/public-headers also compiles this file with the installed headers.
#include <gtest/gtest.h>

#include <vector>

#include "Body.h"
#include "BodyDrawing.h"
#include "BodyJoint.h"
#include "ConvexShape.h"
#include "EventContactEnd.h"
#include "Field.h"
#include "Grip.h"
#include "Integrator.h"
#include "PathManager.h"  // before PhysicsManager.h, whose PM replaces its macro
#include "PhysicsManager.h"
#include "SoftObject.h"
#include "Vec2.h"
#include "World.h"

namespace df {
namespace {

class PublicPhysics : public testing::Test {
 protected:
  PublicPhysics() : scope(world) {}
  ~PublicPhysics() override { world.shutDown(); }
  World world;
  World::Scope scope;
};

TEST_F(PublicPhysics, IntegratorOptionsCanBeSet) {
  naiad::physics::IntegratorOptions options = PM.getIntegrator();
  options.method = naiad::physics::IntegratorMethod::kRadau;
  options.stiff_relative = 1e-6;
  EXPECT_EQ(PM.setIntegrator(options), 0);
  EXPECT_EQ(PM.getIntegrator().method, naiad::physics::IntegratorMethod::kRadau);
  options.relative = 0;
  EXPECT_EQ(PM.setIntegrator(options), -1);
  EXPECT_EQ(PM.getIntegrator().stiff_relative, 1e-6);
}

TEST_F(PublicPhysics, ShapesExposeTheirCorners) {
  auto* p_body = new Body;
  ASSERT_EQ(p_body->setBoxShape(4, 1), 0);
  ASSERT_EQ(p_body->addCircle(1, Vector(0, 2)), 0);
  const std::vector<naiad::physics::ConvexShape>& shapes = p_body->getShapes();
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(shapes[0].count, 4);
  const naiad::physics::Vec2 diagonal = shapes[0].vertices[2] - shapes[0].vertices[0];
  EXPECT_EQ(diagonal, (naiad::physics::Vec2{4, 1 * PM.getAspect()}));
  EXPECT_EQ(shapes[1].radius, 1);
  EXPECT_EQ(p_body->setDrawing(BodyDrawing::FILL, U'o'), 0);
}

class Wind : public Field {
  Vector accelerationAt(Vector displacement, Vector velocity, double) const override {
    return Vector(displacement.x() > 1 ? 0.25 : 0, -velocity.y());
  }
};

TEST_F(PublicPhysics, AFieldMovesABody) {
  const Wind wind;
  auto* p_body = new Body;
  ASSERT_EQ(p_body->setPosition(Vector(12, 5)), 0);
  ASSERT_EQ(p_body->setField(&wind, Vector(10, 5)), 0);
  world.update();
  EXPECT_DOUBLE_EQ(p_body->getVelocity().x(), 0.25);
  EXPECT_DOUBLE_EQ(p_body->getDisplacementFrom(Vector(12, 5)).x(), 0.125);
  EXPECT_EQ(p_body->setField(nullptr), 0);
}

TEST_F(PublicPhysics, PublicHeadersCoverJointsGripsAndSoftBodies) {
  auto* p_body = new Body;
  Joint spring = PM.addSpring(p_body, nullptr, Vector(0, 0), Vector(3, 0), 1);
  EXPECT_TRUE(spring.exists());
  EXPECT_EQ(spring.getLength(), 3);
  EXPECT_FALSE(PM.addSpring(p_body, p_body, 1).exists());
  auto* p_rope = new Rope(Vector(0, 0), Vector(5, 0));
  EXPECT_EQ(p_rope->attach(0, p_body), 0);
  Grip grip;
  EXPECT_EQ(grip.grab(Vector(1000, 1000)), -1);
  EXPECT_FALSE(grip.isHolding());
  EXPECT_EQ(EventContactEnd(p_body, p_rope).getObject2(), p_rope);
}

}  // namespace
}  // namespace df
