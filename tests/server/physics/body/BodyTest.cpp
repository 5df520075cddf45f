#include <memory>

#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Motion.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df {
namespace {

using Bodies = test::PhysicsWorld;

void expectNear(Vector a, Vector b, double tolerance) {
  EXPECT_NEAR(a.x(), b.x(), tolerance);
  EXPECT_NEAR(a.y(), b.y(), tolerance);
}

TEST_F(Bodies, WorldWithoutBodiesHasNoLayer) {
  new Object;
  ticks(3);
  EXPECT_EQ(world.findLayer<naiad::physics::BodyLayer>(), nullptr);
}

TEST_F(Bodies, LongFlightIsPredictedFromOneRecord) {
  PM.setGravity(Vector(0, 0.0123));
  auto* p_ball = new Body;
  p_ball->setVelocity(Vector(0.3, -1.7));
  world.store().setWatched(true);
  world.tick();
  ASSERT_EQ(world.picture().view().changed.size(), 1u);
  const ObjectFacts& facts = world.picture().view().changed[0];
  const naiad::Motion motion{world.picture().view().tick, facts.position, facts.velocity, facts.acceleration};
  for (int i = 0; i < 600; ++i) {
    world.tick();
    const FixedVector drawn = naiad::positionAt(motion, world.picture().view().tick);
    const auto at = toFixed(static_cast<Object*>(p_ball)->getPosition());
    EXPECT_LT(std::abs(drawn.x - at->x) + std::abs(drawn.y - at->y), kFixedOne / 1000) << i;
  }
}

TEST_F(Bodies, DragAndSpringsFollowTheirFormulas) {
  PM.setAspect(1);
  auto* p_dragged = new Body;
  p_dragged->setDrag(2.0 / 30);
  p_dragged->setVelocity(perSecond(Vector(10, 0)));
  auto* p_hung = new Body;
  p_hung->setSpring(Vector(0, 0), perSecondSquared(400), 0);
  p_hung->setPosition(Vector(1, 0));
  auto* p_falling = new Body;
  for (Body* p_body : {p_dragged, p_hung, p_falling}) p_body->setSolidness(SPECTRAL);
  p_falling->setDrag(0, 0.5);
  p_falling->setVelocity(perSecond(Vector(0, 8)));
  ticks(60);
  EXPECT_NEAR(p_dragged->getPosition().x(), 5 * -std::expm1(-4.0), 5e-12);
  EXPECT_NEAR(p_hung->getPosition().x(), std::cos(40.0), 1e-11);
  EXPECT_NEAR(p_falling->getPosition().y(), std::log1p(0.5 * 8 * 2) / 0.5, 1e-8);
}

TEST_F(Bodies, ForcesLastOneTickAndImpulsesActAtOnce) {
  auto* p_body = new Body;
  p_body->setMass(4);
  EXPECT_EQ(p_body->applyForce(Vector(2, 0)), 0);
  EXPECT_EQ(p_body->applyForce(Vector(2, 8)), 0);
  ticks(1);
  expectNear(p_body->getVelocity(), Vector(1, 2), 1e-15);
  expectNear(p_body->getPosition(), Vector(0.5, 1), 1e-15);
  ticks(1);
  expectNear(p_body->getPosition(), Vector(1.5, 3), 1e-15);
  p_body->applyImpulse(Vector(-4, -8));
  expectNear(p_body->getVelocity(), Vector(0, 0), 1e-15);
}

TEST_F(Bodies, BaseObjectSettersMoveTheBody) {
  auto* p_body = new Body;
  Object* p_object = p_body;
  p_object->setPosition(Vector(10, 5));
  p_object->setVelocity(Vector(1, -0.5));
  ticks(1);
  expectNear(p_body->getPosition(), Vector(11, 4.5), 1e-9);
  p_object->setSpeed(0);
  ticks(1);
  expectNear(p_body->getPosition(), Vector(11, 4.5), 1e-9);
}

test::FieldOf planetOf(double pull) {
  return test::FieldOf([pull](Vector d, Vector /*velocity*/) {
    const double r = std::sqrt(d.x() * d.x() + d.y() * d.y());
    return Vector(-pull * d.x() / (r * r * r), -pull * d.y() / (r * r * r));
  });
}

TEST_F(Bodies, AFieldHoldsASatelliteInItsOrbit) {
  PM.setAspect(1);
  const test::FieldOf planet = planetOf(perSecondSquared(1));
  auto* p_moon = new Body;
  p_moon->setField(&planet, Vector(40, 12));
  p_moon->setPosition(Vector(41, 12));
  p_moon->setVelocity(perSecond(Vector(0, 1)));
  ticks(30 * 44);  // seven revolutions take 43.98 s
  const double angle = 44.0;
  expectNear(p_moon->getPosition(), Vector(40 + std::cos(angle), 12 + std::sin(angle)), 1e-9);
}

TEST_F(Bodies, BodyInASingularityFreezesAlone) {
  PM.setAspect(1);
  const test::FieldOf planet = planetOf(1);
  auto* p_doomed = new Body;
  p_doomed->setType("Doomed");
  p_doomed->setField(&planet, Vector(0, 0));
  auto* p_other = new Body;
  p_other->setPosition(Vector(5, 5));
  p_other->setVelocity(Vector(0.25, 0));
  ticks(1);  // the body is in the centre, where the field is 0/0
  EXPECT_TRUE(p_doomed->isFrozen());
  EXPECT_EQ(PM.getQuarantineCount(), 1u);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("Doomed"), std::string::npos);
  expectNear(p_other->getPosition(), Vector(5.25, 5), 1e-15);
  p_doomed->setField(nullptr);
  p_doomed->setVelocity(Vector(1, 0));
  ticks(1);
  expectNear(p_doomed->getPosition(), Vector(1, 0), 1e-12);
}

TEST_F(Bodies, InvalidNumbersAreRefused) {
  auto* p_body = new Body;
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e31}) {
    EXPECT_EQ(p_body->setMass(bad), -1) << bad;
    EXPECT_EQ(p_body->applyForce(Vector(bad, 0)), -1);
    EXPECT_EQ(p_body->applyImpulse(Vector(0, bad)), -1);
    EXPECT_EQ(p_body->setVelocity(Vector(bad, 0)), -1);
    EXPECT_EQ(p_body->setPosition(Vector(bad, 0)), -1);
    EXPECT_EQ(p_body->setDrag(bad), -1);
    EXPECT_EQ(p_body->setDrag(0, bad), -1);
    EXPECT_EQ(p_body->setSpring(Vector(), bad), -1);
    EXPECT_EQ(p_body->setSpring(Vector(bad, 0), 1), -1);
    EXPECT_EQ(p_body->setGravityScale(bad), -1);
    EXPECT_EQ(PM.setGravity(Vector(bad, 0)), -1);
  }
  EXPECT_EQ(p_body->setMass(0), -1);
  EXPECT_EQ(p_body->setMass(-1), -1);
  EXPECT_EQ(p_body->setDrag(-1), -1);
  EXPECT_EQ(p_body->getMass(), 1);
  EXPECT_GT(world.log().refusals(), 40u);
  ticks(1);
  EXPECT_EQ(p_body->getPosition(), Vector());
}

TEST_F(Bodies, ExcessiveForceIsClampedToMaximumSpeed) {
  auto* p_rocket = new Body;
  p_rocket->applyForce(Vector(1e30, 0));
  auto* p_other = new Body;
  p_other->setVelocity(Vector(0.5, 0));
  ticks(1);
  EXPECT_FALSE(p_rocket->isFrozen());
  EXPECT_EQ(p_rocket->getVelocity(), Vector(16777216, 0));
  EXPECT_EQ(PM.getLimitCount(), 2U);  // first the force was limited, then the speed
  expectNear(p_other->getPosition(), Vector(0.5, 0), 1e-15);
}

TEST_F(Bodies, ASceneFarAwayMovesAsAtTheOrigin) {
  const test::FieldOf planet = planetOf(0.1);
  const auto fly = [&](Vector offset) {
    test::OwnWorld there(2, Vector(0, 0.0321));
    auto* p_body = new Body;
    static_cast<Object*>(p_body)->setPosition(offset + Vector(0.25, 0.125));
    p_body->setVelocity(Vector(0.1, -0.7));
    p_body->setDrag(0.01);
    p_body->setField(&planet, offset + Vector(60, 10));
    for (int i = 0; i < 100; ++i) there.world.update();
    return there.world.store().position(p_body->key().slot) - *toFixed(offset);
  };
  const FixedVector home = fly(Vector(0, 0));
  EXPECT_EQ(fly(Vector(1e6, -1e6)), home);
  EXPECT_EQ(fly(Vector(1e9, 1e9)), home);
}

TEST_F(Bodies, OutliveTheirWorld) {
  auto lonely = std::make_unique<World>();
  std::unique_ptr<Body> body;
  {
    const World::Scope inside(*lonely);
    body = std::make_unique<Body>();
  }
  lonely.reset();
  EXPECT_EQ(body->setMass(3), 0);
  EXPECT_EQ(body->getMass(), 3);
  EXPECT_EQ(body->setVelocity(Vector(1, 1)), 0);
  EXPECT_EQ(body->getVelocity(), Vector(1, 1));
}

TEST_F(Bodies, AspectRatioIsFixedOnceABodyExists) {
  EXPECT_EQ(PM.getAspect(), 2);
  EXPECT_EQ(PM.setAspect(kNan), -1);
  EXPECT_EQ(PM.setAspect(8), -1);
  EXPECT_EQ(PM.setAspect(1), 0);
  new Body;
  EXPECT_EQ(PM.setAspect(2), -1);
}

TEST_F(Bodies, ReinsertedBodyContinuesMoving) {
  auto* p_body = new Body;
  p_body->setVelocity(Vector(1, 0));
  ticks(1);
  WM.removeObject(p_body);
  ticks(5);
  expectNear(p_body->getPosition(), Vector(1, 0), 1e-15);
  WM.insertObject(p_body);
  ticks(1);
  expectNear(p_body->getPosition(), Vector(2, 0), 1e-12);
}

}  // namespace
}  // namespace df
