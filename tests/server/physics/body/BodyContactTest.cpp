// Contact events of bodies, and the functions that handlers may call.
#include <numbers>

#include "engine/events/EventOut.h"
#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyContacts : public BodyScene {};

TEST_F(BodyContacts, BothGetOneEventWithTheImpulse) {
  auto* p_a = ball<Listener>(Vector(0, 0), Vector(6, 0));
  auto* p_b = ball<Listener>(Vector(2, 0), Vector(0, 0));
  p_b->setContactEnds();
  ticks(20);
  ASSERT_EQ(p_a->notes.size(), 1u);
  EXPECT_EQ(p_a->notes[0].p_first, p_a);
  EXPECT_EQ(p_a->notes[0].p_second, p_b);
  EXPECT_NEAR(p_a->notes[0].impulse, 6.0 / 30, 1e-12);
  ASSERT_EQ(p_b->notes.size(), 2u);
  EXPECT_TRUE(p_b->notes[0].is_begin);
  EXPECT_FALSE(p_b->notes[1].is_begin);
}

TEST_F(BodyContacts, RestingBodySendsNoEventsOrUpdates) {
  layFloor();
  auto* p_crate = crate<Listener>(Vector(0, -0.75));
  p_crate->setContactEnds();
  ticks(60);
  ASSERT_EQ(p_crate->notes.size(), 1u);
  EXPECT_NEAR(p_crate->getPosition().y(), -0.5, 1e-9);
  EXPECT_EQ(static_cast<Object*>(p_crate)->getAcceleration(), Vector());
  world.store().setWatched(true);
  world.tick();
  for (int i = 0; i < 30; ++i) {
    world.tick();
    EXPECT_TRUE(world.picture().view().changed.empty());
  }
}

TEST_F(BodyContacts, DeletedFloorLetsBodiesFall) {
  Object* p_floor = layFloor(5, 1);
  Body* p_crate = crate(Vector(0, -0.5));
  Body* p_upper = crate(Vector(0, -1.5));
  ticks(10);
  EXPECT_EQ(p_crate->getPosition().y(), -0.5);
  delete p_floor;
  ticks(30);
  EXPECT_NEAR(p_crate->getPosition().y(), 4.5, 1e-9);
  EXPECT_NEAR(p_upper->getPosition().y(), 3.5, 1e-9);
}

TEST_F(BodyContacts, MovedOrSpectralFloorLetsBodiesFall) {
  Object* p_floor = layFloor(5, 1);
  Body* p_crate = crate(Vector(0, -0.5));
  ticks(10);
  p_floor->setPosition(Vector(0, 6));
  ticks(60);
  EXPECT_NEAR(p_crate->getPosition().y(), 4.5, 1e-9);
  p_floor->setSolidness(SPECTRAL);
  ticks(30);
  EXPECT_GT(p_crate->getPosition().y(), 9);
}

TEST_F(BodyContacts, SoftBodiesGetEventsAndPushNothing) {
  auto* p_soft = ball<Listener>(Vector(3, 0), Vector(0, 0));
  p_soft->setSolidness(SOFT);
  p_soft->setContactEnds();
  auto* p_ball = ball<Listener>(Vector(0, 0), Vector(6, 0));
  Object* p_mist = wall(Vector(6, 0), Vector(0.5, 5));
  p_mist->setSolidness(SOFT);
  ticks(60);
  EXPECT_NEAR(p_ball->getPosition().x(), 12, 1e-9);
  EXPECT_EQ(p_soft->getPosition(), Vector(3, 0));
  ASSERT_EQ(p_soft->notes.size(), 2u);
  EXPECT_EQ(p_soft->notes[0].impulse, 0);
  EXPECT_FALSE(p_soft->notes[1].is_begin);
  ASSERT_EQ(p_ball->notes.size(), 2u);
  EXPECT_EQ(p_ball->notes[1].p_second, p_mist);
}

TEST_F(BodyContacts, FastBodyGetsEventForPassedSoftObject) {
  auto* p_ball = ball<Listener>(Vector(0, 0), Vector(3000, 0));
  wall(Vector(30, 0), Vector(0.1, 5))->setSolidness(SOFT);
  ticks(2);
  EXPECT_EQ(p_ball->notes.size(), 1u);
}

TEST_F(BodyContacts, SpectralBodiesTouchNothing) {
  auto* p_ghost = ball<Listener>(Vector(0, 0), Vector(6, 0));
  p_ghost->setSolidness(SPECTRAL);
  wall(Vector(3, 0), Vector(0.5, 5));
  auto* p_ball = ball<Listener>(Vector(1.5, 0), Vector(0, 0));
  ticks(60);
  EXPECT_NEAR(p_ghost->getPosition().x(), 12, 1e-9);
  EXPECT_TRUE(p_ghost->notes.empty());
  EXPECT_TRUE(p_ball->notes.empty());
}

TEST_F(BodyContacts, HandlerMayDeleteBothBodies) {
  class Bomb : public Body {
   public:
    int eventHandler(const Event* p_e) override {
      if (p_e->getType() != COLLISION_EVENT) return 0;
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      Object* p_other = p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1();
      delete p_other;
      delete this;
      return 1;
    }
  };
  ball<Bomb>(Vector(0, 0), Vector(6, 0));
  ball(Vector(2, 0), Vector(0, 0));
  auto* p_third = ball<Listener>(Vector(3, 0), Vector(0, 0));  // it gets the impulse that the first two have
  ticks(20);
  EXPECT_EQ(PM.getBodyCount(), 1);
  EXPECT_NEAR(speedOf(p_third).x(), 6, 1e-9);
}

TEST_F(BodyContacts, HandlerMayCreateBodiesThatReuseRows) {
  class Splitter : public Body {
   public:
    int eventHandler(const Event* p_e) override {
      if (p_e->getType() != COLLISION_EVENT) return 0;
      for (int i = 0; i < 4; ++i) {
        auto* p_part = new Body;
        p_part->setCircle(0.1);
        p_part->setPosition(getPosition() + Vector(-1, 0.5 * i));
        p_part->setVelocity(perSecond(Vector(-3, 0)));
      }
      WM.markForDelete(this);
      return 1;
    }
  };
  wall(Vector(3, 0), Vector(0.5, 20));
  ball<Splitter>(Vector(0, 0), Vector(6, 0));
  ticks(15);
  EXPECT_EQ(PM.getBodyCount(), 4);
  ticks(15);
  EXPECT_EQ(PM.getBodyCount(), 4);
}

TEST_F(BodyContacts, HandlerMaySetTheBodysVelocity) {
  class Shy : public Body {
   public:
    int eventHandler(const Event* p_e) override {
      if (p_e->getType() == COLLISION_EVENT) setVelocity(perSecond(Vector(-1, 0)));
      return 1;
    }
  };
  wall(Vector(3, 0), Vector(0.5, 20));
  Body* p_shy = ball<Shy>(Vector(0, 0), Vector(6, 0));
  ticks(60);
  EXPECT_NEAR(speedOf(p_shy).x(), -1, 1e-12);
}

TEST_F(BodyContacts, ChangedBoxBecomesTheShape) {
  layFloor();
  auto* p_body = new Body;  // it has the box of one character, which is one by one here
  p_body->setPosition(Vector(0, -3));
  ticks(60);
  EXPECT_NEAR(p_body->getPosition().y(), -0.5, 1e-9);
  p_body->setBox(Box(Vector(-0.5, -0.25), 1, 0.5));
  ticks(60);
  EXPECT_NEAR(p_body->getPosition().y(), -0.25, 1e-9);
}

TEST_F(BodyContacts, DragAndSpringsActDuringContact) {
  layFloor();
  Body* p_drop = crate(Vector(0, -0.5));
  p_drop->setDrag(0.05);
  p_drop->setFriction(0);
  p_drop->setVelocity(perSecond(Vector(6, 0)));
  ticks(30);
  EXPECT_EQ(p_drop->getPosition().y(), -0.5);
  EXPECT_NEAR(speedOf(p_drop).x(), 6 * std::exp(-1.5), 1e-9);
  Body* p_held = crate(Vector(20, -0.5));  // it is pulled into the floor
  p_held->setSpring(Vector(20, 3), 0.5, 0.1);
  ticks(60);
  EXPECT_NEAR(p_held->getPosition().y(), -0.5, 1e-9);
}

TEST_F(BodyContacts, AspectRatioAppliesToCollisions) {
  OwnWorld there(2);
  wall(Vector(0, 11), Vector(10, 1));
  auto* p_ball = new Body;
  p_ball->setCircle(2);  // the radius is two cell widths, so that it is one cell high on each side
  p_ball->setPosition(Vector(0, 5));
  p_ball->setVelocity(Vector(0, 0.5));
  for (int i = 0; i < 20; ++i) there.world.update();
  EXPECT_NEAR(p_ball->getPosition().y(), 9, 1e-9);
}

TEST_F(BodyContacts, WorldBoundarySendsAnEventButDoesNotBlock) {
  class Leaver : public Listener {
   public:
    int eventHandler(const Event* p_e) override {
      if (p_e->getType() == OUT_EVENT) ++out;
      return Listener::eventHandler(p_e);
    }
    int out = 0;
  };
  auto* p_ball = ball<Leaver>(Vector(78, 5), Vector(30, 0));
  ticks(5);
  EXPECT_EQ(p_ball->out, 1);
  EXPECT_TRUE(p_ball->notes.empty());
  EXPECT_NEAR(p_ball->getPosition().x(), 83, 1e-9);
}

// Problem 8c of the laboratory (docs/physics/lab.md). The ball that is hit flies far within the tick, to
// walls that were not near before.
TEST_F(BodyContacts, GalperinsBilliardCountsTheDigitsOfPi) {
  long right = 3;
  double mass = 1;
  for (int k = 0; k <= 3; ++k, mass *= 100, right = static_cast<long>(std::numbers::pi * std::pow(10, k))) {
    Object* p_wall = wall(Vector(-1, 0), Vector(1, 1));
    auto* p_light = crate<Listener>(Vector(1.1, 0), Vector(0.1, 0.1));
    auto* p_heavy = crate(Vector(2.3, 0), Vector(0.1, 0.1), mass);
    p_light->setRestitution(1);
    p_heavy->setVelocity(perSecond(Vector(-1, 0)));
    ticks(300);
    EXPECT_EQ(p_light->notes.size(), static_cast<std::size_t>(right)) << k;
    delete p_light;
    delete p_heavy;
    delete p_wall;
  }
}

}  // namespace
}  // namespace df::test
