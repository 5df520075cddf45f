// Heaps that move: a drum that turns, and a cloud of boxes that fall together.
#include <gtest/gtest.h>

#include <algorithm>

#include "RigidScene.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr double kHalf = 0.125;  // of a box
constexpr double kRadius = 6;    // of the drum: from its centre to the middle of each wall
constexpr double kDrumTurn = 0.05 * 2 * std::numbers::pi / 30;  // rad per tick: a turn in 20 s

// A square drum, as body 0, that turns about the origin.
void addDrum(RigidWorld& world) {
  std::vector<ConvexShape> walls(4);
  makeBox(kRadius + 0.5, 0.5, {0, kRadius}, {}, 0, walls[0]);
  makeBox(kRadius + 0.5, 0.5, {0, -kRadius}, {}, 0, walls[1]);
  makeBox(0.5, kRadius + 0.5, {kRadius, 0}, {}, 0, walls[2]);
  makeBox(0.5, kRadius + 0.5, {-kRadius, 0}, {}, 0, walls[3]);
  RigidBody drum = immovable({});
  drum.spin = kDrumTurn;
  world.add(drum, walls);
}

TEST(RigidTumbler, ABoxOfBoxesTurns) {
  RigidWorld world(sleepless());
  addDrum(world);
  const ConvexShape crate = boxShape(kHalf, kHalf);
  constexpr int kBoxes = 150;
  for (int i = 0; i < kBoxes; ++i) {
    world.add(movable({0.35 * (i % 15 - 7), 0.35 * (i / 15 - 5)}, crate), crate);
  }
  double deepest = 0, sum = 0, fastest = 0;
  constexpr int kTicks = 240, kFallen = 40;
  for (int tick = 0; tick < kTicks; ++tick) {
    world.step();
    for (int id = 1; id <= kBoxes; ++id) {
      fastest = std::max(fastest, length(world.body(id).velocity));
      const Vec2 inside = inverse(world.body(0).rotation) * whereIs(world, id);
      ASSERT_LT(std::max(std::fabs(inside.x), std::fabs(inside.y)), kRadius) << id << ' ' << tick;
    }
    if (tick < kFallen) continue;
    deepest = std::max(deepest, world.deepest());
    sum += world.deepest();
  }
  EXPECT_LT(deepest, 0.3 * 2 * kHalf);  // as Box2D with four times the steps: 0.076 of 0.25
  EXPECT_LT(sum / (kTicks - kFallen), 0.1 * 2 * kHalf);
  EXPECT_LT(fastest, std::sqrt(2 * kGravityPerTick * 4 * kRadius));  // nothing is thrown
  EXPECT_GT(world.counters().looks, 1000);           // this is about contacts searched in every sub-step …
  EXPECT_LT(world.counters().impacts, 20 * kTicks);  // … and does not fly from impact to impact
}

TEST(RigidTumbler, ACloudThatFallsTogetherKeepsItsMomentum) {
  RigidWorld world(sleepless());
  const ConvexShape crate = boxShape(kHalf, kHalf);
  constexpr int kSide = 12;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 at = {0.3 * (i % kSide), 0.3 * (i / kSide)};
    RigidBody body = movable(at, crate, 1 + i % 3);
    body.acceleration = {};
    body.velocity = 0.05 * (Vec2{2, 1.5} - at) + Vec2{0.001 * (i % 7), 0.001 * (i % 5)};
    body.spin = 0.02 * (i % 3 - 1);
    world.add(body, crate);
  }
  struct Momentum {
    Vec2 linear;
    double energy = 0;
  };
  const auto momentum = [&] {
    Momentum sum;
    for (int id = 0; id < kSide * kSide; ++id) {
      const RigidBody& b = world.body(id);
      sum.linear += b.velocity / b.inverse_mass;
      sum.energy +=
          0.5 * lengthSquared(b.velocity) / b.inverse_mass + 0.5 * b.spin * b.spin / b.inverse_inertia;
    }
    return sum;
  };
  const Momentum before = momentum();
  // Without restitution what collides loses energy. Sweeps do not settle a shock within one sub-step, so that
  // a few per cent of what it took come back.
  double least = before.energy;
  for (int tick = 0; tick < 60; ++tick) {
    world.step();
    const double now = momentum().energy;
    ASSERT_LE(now, least + 0.1 * before.energy) << tick;
    least = std::min(least, now);
  }
  EXPECT_LE(length(momentum().linear - before.linear), 1e-12 * kSide * kSide);
  EXPECT_GT(world.counters().looks, 100);
  EXPECT_LT(momentum().energy, 0.2 * before.energy);
}

}  // namespace
}  // namespace naiad::physics
