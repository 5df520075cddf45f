// Impulses give no energy to a group, except that of drivers and springs.

#include "SubstepScene.h"
#include "tests/server/physics/SceneRandom.h"

namespace naiad::physics {
namespace {

using namespace test;

// Elastic boxes that rotate in a closed room without gravity.
struct Room : SubstepScene {
  Room(int count, double friction, double most_mass) : SubstepScene(awake()) {
    const double half = count > 20 ? 15 : 6;
    const auto elastic = [&](RigidBody body) {
      body.restitution = 1;
      body.friction = friction;
      return body;
    };
    for (const double side : {-1.0, 1.0}) {
      add(elastic(immovable({0, side * (half + 1)})), boxShape(half + 2, 1));
      add(elastic(immovable({side * (half + 1), 0})), boxShape(1, half + 2));
    }
    SceneRandom uniform{7};
    const int columns = count > 20 ? 10 : 4;
    const double pitch = 2 * half / (columns + 1);
    const ConvexShape box = boxShape(0.5, 0.5);
    for (int i = 0; i < count; ++i) {
      const Vec2 where = {pitch * (1 + i % columns) - half, pitch * (1 + i / columns) - half};
      const Vec2 velocity = {0.6 * uniform() - 0.3, 0.6 * uniform() - 0.3};
      RigidBody body = elastic(floating(where, box, velocity, std::pow(most_mass, uniform())));
      body.spin = 0.3 * uniform() - 0.15;
      boxes.push_back(add(body, box));
    }
  }
  double energy() const {
    double sum = 0;
    for (const int id : boxes) sum += kineticOf(world.body(id));
    return sum;
  }
  std::vector<int> boxes;
};

TEST(SubstepEnergy, ElasticBoxesGainNone) {
  for (const int count : {2, 10, 60}) {
    for (const double friction : {0.0, 0.5}) {
      for (const double most_mass : {1.0, 1000.0}) {
        Room room(count, friction, most_mass);
        double before = room.energy();
        for (int tick = 0; tick < 400; ++tick) {
          room.ticks(1);
          const double now = room.energy();
          ASSERT_LE(now, before * (1 + 2e-6)) << count << ' ' << friction << ' ' << most_mass << ' ' << tick;
          before = now;
        }
        EXPECT_GT(before, 0);
      }
    }
  }
}

// The push that undoes an overlap moves the bodies, but leaves no speed beyond rounding: the bodies have a
// mass of 78 and are pushed at 0.1 cells a tick, and a float rounds that by 6e-9.
TEST(SubstepEnergy, OverlappingBodiesAtRestStayAtRest) {
  SubstepScene scene(awake());
  std::vector<int> boxes;
  const ConvexShape box = boxShape(0.5, 0.5);
  for (int i = 0; i < 12; ++i) {
    RigidBody body = floating({0.7 * (i % 4), 0.8 * (i / 4)}, box, {}, 1 + i);
    body.rotation = rotationBy(0.3 * i);
    boxes.push_back(scene.add(body, box));
  }
  for (int tick = 0; tick < 100; ++tick) {
    scene.ticks(1);
    double energy = 0;
    for (const int id : boxes) energy += kineticOf(scene.world.body(id));
    ASSERT_LT(energy, 1e-8) << tick;
  }
  EXPECT_LT(scene.world.deepest(), 0.05);
  EXPECT_GT(scene.world.counters().scaled, 0);
}

// The correction of a gain takes speed, not the impulses that carry the pile.
TEST(SubstepEnergy, TallPyramidStandsAndSleeps) {
  constexpr int kRows = 60;
  SubstepScene scene;
  scene.addFloor();
  int top = -1;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i) top = scene.addCrate({i - 0.5 * (kRows - row - 1), -0.5 - row});
  }
  scene.ticks(150);
  EXPECT_TRUE(scene.world.isAsleep(top));
  EXPECT_NEAR(scene.at(top).y, 0.5 - kRows, 0.5);
  EXPECT_GT(scene.world.counters().scaled, 0);
}

// A kinematic body does work on what it hits and carries.
TEST(SubstepEnergy, DriversGiveTheirFullWork) {
  SubstepScene scene(awake());
  const ConvexShape box = boxShape(0.5, 0.5);
  RigidBody bat = immovable({0, 0});
  bat.velocity = {0.5, 0};
  bat.restitution = 1;
  scene.add(bat, box);
  const int ball = scene.add(floating({3, 0}, box), box);
  scene.ticks(20);
  EXPECT_NEAR(scene.world.body(ball).velocity.x, 1, 1e-4);

  RigidBody lift = immovable({100, 0.5});
  lift.velocity = {0.05, -0.1};
  scene.add(lift, boxShape(3, 0.5));
  const int crate = scene.addCrate({100, -0.5});
  scene.ticks(60);
  EXPECT_NEAR(scene.world.body(crate).velocity.y, -0.1, 1e-3);
  EXPECT_NEAR(scene.world.body(crate).velocity.x, 0.05, 1e-3);
  EXPECT_EQ(scene.world.counters().scaled, 0);
}

}  // namespace
}  // namespace naiad::physics
