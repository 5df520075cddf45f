// Turning bodies through WM.update(): their solver moves them, and games get their events.
#include <numbers>

#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyRigids : public BodyScene {
 protected:
  BodyRigids() { PM.setGravity(perSecondSquared(Vector(0, 10))); }
};

TEST_F(BodyRigids, SleepingCratesPublishNothing) {
  layFloor(100);
  turningCrate(Vector(0, -0.5));
  turningCrate(Vector(0, -1.5), Vector(0.5, 0.5), 100);
  ticks(300);
  world.store().setWatched(true);
  world.tick();
  world.tick();
  EXPECT_TRUE(world.picture().view().changed.empty());
}

TEST_F(BodyRigids, LoneBodyFliesExactly) {
  Body* p_crate = turningCrate(Vector(0, 0));
  p_crate->setSpin(0.1);
  p_crate->setVelocity(perSecond(Vector(3, -20)));
  ticks(60);
  EXPECT_NEAR(p_crate->getPosition().x(), 6, 1e-12);
  EXPECT_NEAR(p_crate->getPosition().y(), -20, 1e-11);
  EXPECT_NEAR(speedOf(p_crate).x(), 3, 1e-11);
  EXPECT_NEAR(speedOf(p_crate).y(), 0, 1e-11);
  EXPECT_NEAR(p_crate->getAngle(), 6 - 2 * std::numbers::pi, 1e-12);
  EXPECT_EQ(layer().rigidCounters().ticks, 0);
}

TEST_F(BodyRigids, ElasticImpactKeepsItsEnergyAtAnyMassRatio) {
  for (const double mass : {1.0, 1e4, 1e9}) {
    OwnWorld own;
    Body* p_heavy = turningCrate(Vector(0, 0), Vector(1, 1), mass);
    Body* p_light = turningCrate(Vector(6, 0.4));
    for (Body* p_body : {p_heavy, p_light}) {
      p_body->setRestitution(1);
      p_body->setFriction(0);
    }
    p_light->setVelocity(Vector(-0.6, 0));
    p_light->setSpin(0.2);
    const double before = kineticOf(p_heavy) + kineticOf(p_light);
    for (int tick = 0; tick < 30; ++tick) own.world.update();
    EXPECT_GT(p_light->getVelocity().x(), -0.5) << mass;
    EXPECT_NEAR((kineticOf(p_heavy) + kineticOf(p_light)) / before, 1, 1e-9) << mass;
  }
}

TEST_F(BodyRigids, NonTurningBodiesKeepTheExactSolver) {
  layFloor(100);
  turningCrate(Vector(-20, -2));
  auto* p_ball = ball<Listener>(Vector(20, -5.5), Vector());
  for (int tick = 0; tick < 3000; ++tick) {
    ticks(1);
    const double energy = -p_ball->getPosition().y() - 0.5 + std::pow(speedOf(p_ball).y(), 2) / 20;
    ASSERT_NEAR(energy, 5, 1e-9) << tick;
  }
  EXPECT_GT(layer().rigidCounters().ticks, 0);
  EXPECT_GT(layer().impactCounters().impacts, 3);
}

// A crate that cannot turn lies on the floor. One that can turn falls on it, so the RigidWorld moves both.
TEST_F(BodyRigids, SolverChangeRepeatsNoContactEvents) {
  Object* p_floor = layFloor(100);
  auto* p_crate = crate<Listener>(Vector(0, -0.75));
  p_crate->setContactEnds();
  ticks(30);
  ASSERT_EQ(p_crate->notes.size(), 1u);
  auto* p_other = turningCrate<Listener>(Vector(0, -3));
  ticks(90);
  // The crate may hop, but begins and ends of each contact alternate.
  auto touches = p_crate->expectTurns();
  EXPECT_TRUE((touches[{p_crate, p_floor}]));
  EXPECT_FALSE(p_other->notes.empty());
  EXPECT_NEAR(p_crate->getPosition().y(), -0.5, 1e-3);
  EXPECT_NEAR(p_other->getPosition().y(), -1.5, 1e-2);
}

// A crate hits the end of a plank on a hinge.
TEST_F(BodyRigids, JointedBodyCollides) {
  auto* p_plank = new Listener;
  p_plank->setBoxShape(6, 0.5);
  p_plank->setTurning();
  ASSERT_TRUE(PM.addHinge(nullptr, p_plank, Vector()).exists());
  ticks(30);
  EXPECT_GT(layer().linkageCounters().substeps, 0);  // nothing is near the plank
  EXPECT_NEAR(p_plank->getAngle(), 0, 1e-12);
  Body* p_crate = crate(Vector(2.5, -4));
  ticks(35);
  EXPECT_GT(layer().rigidCounters().contacts, 0);
  EXPECT_GT(p_plank->getAngle(), 0.1);
  EXPECT_EQ(p_plank->notes.size(), 1u);
  EXPECT_NEAR(std::hypot(p_plank->getPosition().x(), p_plank->getPosition().y()), 0, 1e-3);
  delete p_crate;
  ticks(5);
  EXPECT_NEAR(std::hypot(p_plank->getPosition().x(), p_plank->getPosition().y()), 0, 1e-3);
}

TEST_F(BodyRigids, StackedBodiesMayBeDeleted) {
  layFloor();
  std::vector<Body*> crates;
  for (int i = 0; i < 5; ++i) {
    crates.push_back(turningCrate(Vector(0, -0.5 - i)));
  }
  ticks(30);
  delete crates[0];
  delete crates[2];
  auto* p_new = turningCrate(Vector(10, -5));
  ticks(90);
  EXPECT_NEAR(crates[1]->getPosition().y(), -0.5, 2e-2);
  EXPECT_NEAR(crates[3]->getPosition().y(), -1.5, 2e-2);
  EXPECT_NEAR(crates[4]->getPosition().y(), -2.5, 2e-2);
  EXPECT_NEAR(p_new->getPosition().y(), -0.5, 1e-2);
}

// A body of 10^4 crate masses rolls into a row of crates. They move on before it and are not thrown.
TEST_F(BodyRigids, HeavyBodyPushesARowOfCrates) {
  constexpr double kSpeed = 0.2;
  for (const double mass : {2e3, 1e4, 3e4, 1e5}) {
    for (const int count : {3, 5}) {
      for (const bool is_box : {false, true}) {
        for (const double restitution : {0.0, 0.3}) {
          OwnWorld own(1, Vector(0, 0.01));
          wall(Vector(0, 0.5), Vector(500, 0.5));
          std::vector<Body*> crates;
          for (int i = 0; i < count; ++i) crates.push_back(turningCrate(Vector(1.1 * i, -0.5)));
          Body* p_heavy = turningCrate(Vector(-3, -2), Vector(2, 2), mass);
          if (!is_box) p_heavy->setCircle(2);
          p_heavy->setVelocity(Vector(kSpeed, 0));
          crates.push_back(p_heavy);
          for (Body* p_body : crates) p_body->setRestitution(restitution);
          double most = kineticOf(p_heavy), fastest = 0;
          for (int tick = 0; tick < 80; ++tick) {
            own.world.update();
            double energy = 0;
            for (const Body* p_body : crates) {
              energy += kineticOf(p_body);
              fastest = std::max(fastest, std::hypot(p_body->getVelocity().x(), p_body->getVelocity().y()));
            }
            EXPECT_LE(energy, most + 1e-4 * mass * kSpeed * kSpeed) << mass << ' ' << count << ' ' << tick;
            most = std::min(most, energy);
          }
          EXPECT_LE(fastest, 4 * kSpeed) << mass << ' ' << count << ' ' << is_box << ' ' << restitution;
        }
      }
    }
  }
}

// The nail that holds the lamp does not have to be HARD.
TEST_F(BodyRigids, LampHangsFromASpectralNail) {
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    PM.setAccuracy(accuracy);
    auto* p_nail = new Body;
    p_nail->setSolidness(SPECTRAL);
    p_nail->setKinematic();
    Body* p_lamp = turningCrate(Vector(0, 3));
    PM.addDistance(p_nail, p_lamp);
    Object* p_wall = wall(Vector(1, 3), Vector(0.5, 2));  // the lamp leans against it
    ticks(90);
    EXPECT_NEAR(p_lamp->getPosition().y(), 3, 0.01);
    for (Object* p_object : {static_cast<Object*>(p_nail), static_cast<Object*>(p_lamp), p_wall}) {
      WM.markForDelete(p_object);
    }
    ticks(1);
  }
}

// Two bodies that meet in the air, without a bounce, fall together from then on, whenever in the tick they
// meet.
TEST(BodyRigidFalls, CentreOfMassFallsFreelyThroughAnInelasticImpact) {
  for (const double gap : {0.1, 0.7, 1.3, 1.9}) {
    for (const double mass : {1.0, 3.0}) {
      for (const double scale : {1.0, 2.0}) {
        OwnWorld own;
        PM.setGravity(Vector(0, 0.01));
        Body* p_hit = BodyScene::turningCrate(Vector());
        Body* p_hitting = BodyScene::turningCrate(Vector(1 + gap, 0));
        p_hitting->setMass(mass);
        p_hitting->setGravityScale(scale);
        p_hitting->setVelocity(Vector(-2, 0));
        for (Body* p_body : {p_hit, p_hitting}) {
          p_body->setRestitution(0);
          p_body->setFriction(0);
        }
        for (int tick = 1; tick <= 3; ++tick) {
          own.world.update();
          const double fallen = (p_hit->getPosition().y() + mass * p_hitting->getPosition().y()) / (1 + mass);
          const double gravity = 0.01 * (1 + mass * scale) / (1 + mass);
          EXPECT_NEAR(fallen, 0.5 * gravity * tick * tick, 1e-8) << gap << ' ' << mass << ' ' << scale;
        }
      }
    }
  }
}

}  // namespace
}  // namespace df::test
