// Bodies that move far in a tick stop where they first touch something.

#include "SubstepScene.h"
#include "tests/server/physics/SceneRandom.h"

namespace naiad::physics {
namespace {

using namespace test;

enum class BulletKind { kStick, kDisc };

// Returns how many shots have their centre behind the wall at any time.
int through(BulletKind kind, double speed, double restitution, int shots) {
  SceneRandom uniform{7};
  int passed = 0;
  for (int shot = 0; shot < shots; ++shot) {
    SubstepScene scene;
    scene.add(immovable({0, 0}), boxShape(0.5, 1e5));  // a wall 1 cell thick
    const ConvexShape bullet = kind == BulletKind::kStick ? boxShape(0.6, 0.1) : circleShape(0.25);
    RigidBody flying = movable({-1.5 - 3 * speed * uniform(), 0}, bullet);
    const double slant = 1.2 * uniform() - 0.6;
    flying.velocity = speed * Vec2{std::cos(slant), std::sin(slant)};
    flying.rotation = rotationBy(6.28 * uniform());
    flying.spin = 0.6 * uniform() - 0.3;
    flying.acceleration = {};
    flying.restitution = restitution;
    const int id = scene.add(flying, bullet);
    bool is_through = false, has_met = false;
    for (int tick = 0; tick < 10; ++tick) {
      scene.ticks(1);
      has_met = has_met || !scene.world.events().empty();
      is_through = is_through || scene.at(id).x > 0;
    }
    EXPECT_TRUE(has_met) << speed << ' ' << shot;
    passed += is_through ? 1 : 0;
  }
  return passed;
}

TEST(SubstepFast, DiscsAndSticksDoNotTunnel) {
  for (const BulletKind kind : {BulletKind::kDisc, BulletKind::kStick}) {
    for (const double speed : {1.0, 3.0, 10.0, 100.0, 1e3, 1e4}) {
      for (const double restitution : {0.0, 1.0}) {
        EXPECT_EQ(through(kind, speed, restitution, 300), 0)
            << (kind == BulletKind::kDisc ? "disc " : "stick ") << speed << ' ' << restitution;
      }
    }
  }
}

TEST(SubstepFast, RotatingBarsDoNotPassThinWalls) {
  SceneRandom uniform{5};
  for (int shot = 0; shot < 1500; ++shot) {
    SubstepScene scene(awake());
    const double half_wall = uniform.oneOf(0.005, 0.025, 0.1, 0.25, 0.5), length = uniform.oneOf(0.3, 1, 3);
    const ConvexShape wall = boxShape(half_wall, 1e6), bar = boxShape(length, uniform.oneOf(0.02, 0.05, 0.2));
    RigidBody obstacle = immovable({0, 0});
    const double speed = std::pow(10, 4 * uniform() - 1);
    RigidBody flying = movable({-length - 0.3 - half_wall - uniform() * (1 + speed), 0}, bar);
    flying.velocity = {speed, speed * (uniform() - 0.5)};
    flying.rotation = rotationBy(6.28 * uniform());
    flying.spin = uniform.oneOf(0, 0.3, 3.3, 10, 15);
    flying.acceleration = {uniform.oneOf(0, 0.01), 0};
    obstacle.restitution = uniform.oneOf(0, 0, 0.3, 1);
    obstacle.friction = flying.friction = uniform.oneOf(0, 0.5, 1);
    scene.add(obstacle, wall);
    const int id = scene.add(flying, bar);
    for (int tick = 0; tick < 30; ++tick) {
      scene.ticks(1);
      ASSERT_LE(scene.at(id).x, 0) << "shot " << shot << " at " << speed << ", tick " << tick;
    }
  }
}

enum class WallMotion { kApproaches, kHits, kTurns, kTurnsAndMoves };

// Returns how many bars have their centre behind a kinematic wall at any time.
int throughMoving(WallMotion motion, int shots) {
  SceneRandom uniform{11};
  const bool turns = motion == WallMotion::kTurns || motion == WallMotion::kTurnsAndMoves;
  const double half_length = turns ? 30 : 1e5;
  int passed = 0;
  for (int shot = 0; shot < shots; ++shot) {
    SubstepScene scene(awake());
    const double speed = std::pow(10, turns ? 2 * uniform() - 1 : 6 * uniform());
    const double half_wall =
        speed < 1e4 ? uniform.oneOf(0.005, 0.05, 0.5) : 0.5;  // floats round faster motion
    const ConvexShape bar = boxShape(uniform.oneOf(0.3, 1), uniform.oneOf(0.02, 0.05, 0.2));
    const double away = 2 + half_wall + 3 * uniform() * (motion == WallMotion::kTurns ? 4 : speed);
    RigidBody wall = immovable({0, 0});
    RigidBody flying = floating({-away, (turns ? 15 : 100) * (uniform() - 0.5)}, bar);
    flying.rotation = rotationBy(6.28 * uniform());
    flying.spin = uniform.oneOf(0, 0.3, 3, 100);
    wall.restitution = uniform.oneOf(0, 0.3, 1);
    wall.friction = flying.friction = uniform.oneOf(0, 0.6);
    if (motion == WallMotion::kApproaches) flying.velocity = {speed, 0}, wall.velocity = {-0.5 * speed, 0};
    if (motion == WallMotion::kHits) wall.velocity = {-speed, 0.3 * speed * (uniform() - 0.5)};
    if (turns) wall.spin = uniform.oneOf(-1, 1) * std::pow(10, 1.5 * uniform() - 1.5);
    if (motion == WallMotion::kTurnsAndMoves) wall.velocity = {-speed, 0};
    const int wall_id = scene.add(wall, boxShape(half_wall, half_length)), id = scene.add(flying, bar);
    for (int tick = 0; tick < 10; ++tick) {
      scene.ticks(1);
      const RigidBody& now = scene.world.body(wall_id);
      const Vec2 at = inverse(now.rotation) * (scene.world.body(id).place - now.place);
      if (std::fabs(at.y) > half_length - 2) break;  // it flies past the wall's end
      if (at.x <= 0) continue;
      ++passed;
      break;
    }
  }
  return passed;
}

TEST(SubstepFast, BarsDoNotPassMovingWalls) {
  EXPECT_EQ(throughMoving(WallMotion::kApproaches, 400), 0);
  EXPECT_EQ(throughMoving(WallMotion::kHits, 400), 0);
  EXPECT_EQ(throughMoving(WallMotion::kTurns, 400), 0);
  EXPECT_EQ(throughMoving(WallMotion::kTurnsAndMoves, 400), 0);
}

// The plough moves over several widths of the crate a tick. Nothing else would wake or push the crate.
TEST(SubstepFast, KinematicPloughPushesASleepingCrate) {
  SleepingCrate scene;
  RigidBody plough = immovable({-20, -2});
  plough.velocity = {3, 0};
  const int id = scene.add(plough, boxShape(0.5, 1.9));
  for (int tick = 0; tick < 20; ++tick) {
    scene.ticks(1);
    ASSERT_GT(scene.at(scene.crate).x, scene.at(id).x) << tick;
  }
  EXPECT_NEAR(scene.world.body(scene.crate).velocity.x, 3, 0.1);
}

TEST(SubstepFast, FastBodyStopsAtContactAndContinuesNextTick) {
  SubstepScene scene;
  scene.add(immovable({10, 0}), boxShape(0.5, 50));
  const ConvexShape disc = circleShape(0.25);
  RigidBody ball = floating({0, 0}, disc, {100, 0});
  ball.restitution = 1;
  const int id = scene.add(ball, disc);
  scene.ticks(1);
  EXPECT_TRUE(scene.world.isStopped(id));
  EXPECT_EQ(scene.world.counters().stopped, 1);
  EXPECT_NEAR(scene.at(id).x, 9.25, 1e-3);
  EXPECT_NEAR(scene.world.body(id).velocity.x, 100, 1e-4);
  scene.ticks(1);
  EXPECT_FALSE(scene.world.isStopped(id));
  EXPECT_NEAR(scene.world.body(id).velocity.x, -100, 1e-2);
}

// Two bodies hit each other in flight, and a body hits a sleeping stack.
TEST(SubstepFast, FastBodiesDoNotPassEachOther) {
  for (const double speed : {2.0, 30.0, 1e3}) {
    SubstepScene scene;
    const ConvexShape crate = boxShape(0.5, 0.5);
    const int one = scene.add(floating({-1.7 * speed, 0}, crate, {speed, 0}), crate);
    const int other = scene.add(floating({1.4 * speed, 0}, crate, {-speed, 0}), crate);
    for (int tick = 0; tick < 10; ++tick) {
      scene.ticks(1);
      ASSERT_LT(scene.at(one).x, scene.at(other).x) << speed << ' ' << tick;
    }
    EXPECT_LT(scene.speed(one), 0.01 * speed);
  }
}

TEST(SubstepFast, FastBodyWakesAndPushesASleepingOne) {
  SleepingCrate scene;
  const ConvexShape disc = circleShape(0.3);
  const int id = scene.add(floating({-90, -0.5}, disc, {40, 0}), disc);
  for (int tick = 0; tick < 6; ++tick) {
    scene.ticks(1);
    ASSERT_LT(scene.at(id).x, scene.at(scene.crate).x);
  }
  EXPECT_FALSE(scene.world.isAsleep(scene.crate));
  EXPECT_GT(scene.world.body(scene.crate).velocity.x, 5);
}

// One of two joined bodies meets a wall, or is hit by a fast body, at any time of the tick. They do not turn.
TEST(SubstepFast, JoinedBodiesStopTogether) {
  for (const JointKind kind : {JointKind::kHinge, JointKind::kWeld}) {
    for (const double speed : {1.0, 3.0, 10.0}) {
      for (int i = 0; i < 20; ++i) {
        for (const bool is_hit : {false, true}) {
          SubstepScene scene;
          const ConvexShape shape = boxShape(0.5, 0.5);
          const double away = 1.5 + 0.05 * i * speed;
          RigidBody body = floating({0, 0}, shape, {is_hit ? 0 : speed, 0});
          body.inverse_inertia = 0;
          const int one = scene.add(body, shape);
          body.place = body.place + Vec2{0, 2};
          const int other = scene.add(body, shape);
          if (is_hit) {
            scene.add(floating({away, 0}, shape, {-speed, 0}), shape);
          } else {
            scene.add(immovable({away, 0}), boxShape(0.5, 0.5));
          }
          const int joint = scene.join({}, kind, one, other, {0, 1}, {0, -1});
          for (int tick = 0; tick < 8; ++tick) {
            scene.ticks(1);
            EXPECT_LE(scene.gap(joint), 0.15 + 0.03 * speed)
                << static_cast<int>(kind) << ' ' << speed << ' ' << i << ' ' << is_hit << ' ' << tick;
          }
        }
      }
    }
  }
}

// The crates that are hit push others. The ram behind them is as fast, but does not move into them.
TEST(SubstepFast, RamDoesNotPenetrateThePushedCrates) {
  SubstepScene scene;
  const ConvexShape block = boxShape(4, 4);
  RigidBody ram = floating({-80.0 / 3, 0}, block, {4.0 / 3, 0}, 3200);
  const int ram_id = scene.add(ram, block);
  const ConvexShape crate = boxShape(0.2, 0.2);
  std::vector<int> crates;
  for (int i = 0; i < 20 * 40; ++i) {
    crates.push_back(scene.add(floating({4.67 + 0.4 * (i / 40), 0.4 * (i % 40 - 19.5)}, crate), crate));
  }
  scene.ticks(20);
  const auto depth = [&](int id) {  // of its centre in the ram
    const Vec2 apart = scene.at(id) - scene.at(ram_id);
    return 4 - std::max(std::fabs(apart.x), std::fabs(apart.y));
  };
  EXPECT_LT(scene.most(12, [&] { return scene.largest(crates, depth); }), 0.2);
  EXPECT_GT(scene.world.counters().stopped, 0);
}

}  // namespace
}  // namespace naiad::physics
