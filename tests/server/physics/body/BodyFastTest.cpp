// The level ACCURACY_FAST through the public functions: events, free flight, changes of level, sleep.
#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyFast : public BodyScene {
 protected:
  BodyFast() {
    PM.setGravity(perSecondSquared(Vector(0, 10)));
    EXPECT_EQ(PM.setAccuracy(ACCURACY_FAST), 0);
  }
};

TEST_F(BodyFast, AccuracyLevelIsKeptPerWorld) {
  EXPECT_EQ(PM.getAccuracy(), ACCURACY_FAST);
  const std::uint64_t refusals = world.log().refusals();
  EXPECT_EQ(PM.setAccuracy(static_cast<Accuracy>(7)), -1);
  EXPECT_EQ(world.log().refusals(), refusals + 1);
  EXPECT_EQ(PM.getAccuracy(), ACCURACY_FAST);
  EXPECT_EQ(PM.setAccuracy(ACCURACY_DEFAULT), 0);
  EXPECT_EQ(PM.getAccuracy(), ACCURACY_DEFAULT);
  EXPECT_EQ(world.log().refusals(), refusals + 1);

  EXPECT_TRUE(PM.isSleeping());
  PM.setSleeping(false);
  EXPECT_FALSE(PM.isSleeping());

  World other;
  const World::Scope other_scope(other);
  EXPECT_EQ(PM.getAccuracy(), ACCURACY_DEFAULT);  // the default level, because each world has its own level
  EXPECT_TRUE(PM.isSleeping());
}

TEST_F(BodyFast, RestingCrateGetsOneContactEvent) {
  Object* p_floor = wall(Vector(0, 5), Vector(100, 5));
  auto* p_crate = turningCrate<Listener>(Vector(0, -2));
  ticks(200);
  ASSERT_EQ(p_crate->notes.size(), 1u);
  EXPECT_TRUE(p_crate->notes[0].is_begin);
  EXPECT_EQ(p_crate->notes[0].p_first, p_crate);
  EXPECT_EQ(p_crate->notes[0].p_second, p_floor);
  EXPECT_GT(p_crate->notes[0].impulse, 0);
  EXPECT_NEAR(p_crate->getPosition().y(), -0.5, 5e-3);
  EXPECT_GT(layer().substepCounters().contacts, 0);
  EXPECT_EQ(layer().rigidCounters().ticks, 0);
}

TEST_F(BodyFast, FreeFlightIsEqualAtBothLevels) {
  const auto fly = [](Accuracy accuracy) {
    OwnWorld own(1, perSecondSquared(Vector(0, 10)), accuracy);
    wall(Vector(0, 40), Vector(100, 5));
    std::vector<Body*> bodies;
    for (int i = 0; i < 6; ++i) {
      Body* p_body = i % 2 == 0 ? crate(Vector(6.3 * i, 0.1 * i)) : ball(Vector(6.3 * i, 0.1 * i), Vector());
      p_body->setVelocity(perSecond(Vector(0.7 * i, -7.1 - i)));
      p_body->setTurning(i % 3 != 0);
      p_body->setSpin(0.03 * i);
      if (i == 4) p_body->setDrag(0.02);
      bodies.push_back(p_body);
    }
    Body* p_resting = crate(Vector(-50, 34.5));  // has a contact, far from the others
    p_resting->setTurning();
    return own.states(60, bodies);
  };
  EXPECT_EQ(fly(ACCURACY_DEFAULT), fly(ACCURACY_FAST));
}

TEST_F(BodyFast, LevelChangeRepeatsNoContactEvents) {
  wall(Vector(0, 5), Vector(100, 5));
  std::vector<Listener*> pile;
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 4 - row; ++i) {
      pile.push_back(turningCrate<Listener>(Vector(1.1 * i + 0.55 * row, -0.5 - row)));
      pile.back()->setContactEnds();
    }
  }
  ticks(60);
  for (Listener* p_crate : pile) {
    EXPECT_GT(p_crate->begins(), 0);
    p_crate->notes.clear();
  }
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST, ACCURACY_DEFAULT}) {
    ASSERT_EQ(PM.setAccuracy(accuracy), 0);
    ticks(20);
    for (std::size_t i = 0; i < pile.size(); ++i) {
      EXPECT_TRUE(pile[i]->notes.empty()) << accuracy << ' ' << i;
      EXPECT_LT(std::fabs(speedOf(pile[i]).y()), 0.1) << accuracy << ' ' << i;
    }
  }
  EXPECT_GT(layer().rigidCounters().ticks, 0);
  for (std::size_t i = 0; i < pile.size(); ++i) {
    EXPECT_NEAR(pile[i]->getPosition().y(), -0.5 - (i < 4 ? 0 : i < 7 ? 1 : i < 9 ? 2 : 3), 0.05) << i;
  }
  EXPECT_EQ(world.log().refusals(), 0U);
  for (const std::string& line : lines) EXPECT_EQ(line.find("frozen"), std::string::npos) << line;
}

// Joints between bodies and to the world hold before and after a change of level.
TEST_F(BodyFast, JointsSurviveALevelChange) {
  Body* p_plank = turningCrate(Vector(2, 0), Vector(2, 0.2));
  Joint hinge = PM.addHinge(nullptr, p_plank, Vector(0, 0));
  ASSERT_TRUE(hinge.exists());
  const auto gapOf = [&] {
    const Vector place = p_plank->getPosition();
    const double angle = p_plank->getAngle();
    return std::hypot(place.x() - 2 * std::cos(angle), place.y() - 2 * std::sin(angle));
  };
  for (const Accuracy accuracy : {ACCURACY_FAST, ACCURACY_DEFAULT, ACCURACY_FAST}) {
    PM.setAccuracy(accuracy);
    for (int tick = 0; tick < 30; ++tick) {
      ticks(1);
      ASSERT_LT(gapOf(), 0.02) << accuracy << ' ' << tick;
    }
  }
  EXPECT_TRUE(hinge.exists());
  EXPECT_GT(p_plank->getAngle(), 0.5);
}

TEST_F(BodyFast, ASleepingHeapPublishesNothing) {
  wall(Vector(0, 5), Vector(100, 5));
  std::vector<Body*> heap;
  for (int i = 0; i < 8; ++i) {
    heap.push_back(turningCrate(Vector(0.1 * (i % 2), -0.5 - i)));
  }
  ticks(200);
  world.store().setWatched(true);
  world.tick();
  for (int tick = 0; tick < 20; ++tick) {
    std::vector<BodyBits> before, after;
    for (const Body* p_body : heap) before.push_back(stateBits(p_body));
    world.tick();
    for (const Body* p_body : heap) after.push_back(stateBits(p_body));
    ASSERT_EQ(before, after) << tick;
    ASSERT_TRUE(world.picture().view().changed.empty()) << tick;
  }
  const std::int64_t contacts = layer().substepCounters().contacts;
  ticks(10);
  EXPECT_EQ(layer().substepCounters().contacts, contacts);
  PM.setSleeping(false);
  ticks(10);
  EXPECT_GE(layer().substepCounters().contacts, contacts + 80);  // every contact is solved in every tick
}

}  // namespace
}  // namespace df::test
