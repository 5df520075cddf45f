#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/impact/ImpactWorld.h"
#include "tests/support/Quad.h"

namespace naiad::physics {
namespace {

constexpr double kTicks = 30;                        // per second
constexpr double kGravity = 10 / (kTicks * kTicks);  // 10 per second²

ImpactBody box(Vec2 at, Vec2 half = {0.5, 0.5}) {
  ImpactBody body;
  body.place = placeAt(at);
  body.half = half;
  return body;
}
ImpactBody ball(Vec2 at, double radius = 0.5) {
  ImpactBody body = box(at, {radius, 0});
  body.shape = ImpactShape::kCircle;
  return body;
}
ImpactBody moving(ImpactBody body, Vec2 velocity, double restitution = 0) {
  body.velocity = velocity;
  body.restitution = restitution;
  return body;
}
ImpactBody fixed(ImpactBody body) {
  body.inverse_mass = 0;
  return body;
}
ImpactBody falling(ImpactBody body, double gravity = kGravity) {
  body.acceleration = {0, gravity};
  return body;
}
Vec2 at(const ImpactWorld& world, int id) {
  return world.body(id).place - Place{};
}

// Problem 7 of docs/physics/lab.md: e = 0.8 from a height of 10, compared with the closed form, up to the
// stop.
TEST(ImpactWorld, BouncingBallMatchesTheClosedFormAndStops) {
  ImpactWorld world;
  world.add(fixed(box({0, 1}, {5, 1})));  // its upper edge is y = 0
  const int id = world.add(falling(moving(ball({0, -10.5}), {0, 0}, 0.8)));
  const double fall = std::sqrt(2 * 10 / 10.0) * kTicks, bounce = std::sqrt(2 * kGravity * 10);
  double stopped = -1;
  for (int tick = 1; tick < 600; ++tick) {
    ASSERT_EQ(world.step(), ImpactStepStatus::kDone);
    // Computes the height in the flight that contains this tick, by the closed form.
    double begin = fall, speed = 0.8 * bounce, height = 0;
    if (tick < fall) {
      height = 10 - 0.5 * kGravity * tick * tick;
    } else {
      while (speed > 1e-9 && begin + 2 * speed / kGravity < tick) {
        begin += 2 * speed / kGravity;
        speed *= 0.8;
      }
      const double t = tick - begin;
      height = speed > 1e-9 ? speed * t - 0.5 * kGravity * t * t : 0;
    }
    EXPECT_NEAR(-0.5 - at(world, id).y, height, 1e-9) << tick;
    if (stopped < 0 && world.body(id).velocity == Vec2{}) stopped = tick;
  }
  EXPECT_NEAR(stopped, 12.727922061357857 * kTicks, 1);  // √2·(1 + 0.8)/(1 − 0.8) seconds
}

// Problem 8.
TEST(ImpactWorld, NewtonsCradlePassesTheSpeedThrough) {
  for (const double gap : {0.0, 0.01}) {
    ImpactWorld world;
    for (int i = 0; i < 5; ++i) world.add(moving(ball({i * (1 + gap), 0}), {}, 1));
    world.set(0, moving(ball({-3, 0}), {5, 0}, 1));
    for (int tick = 0; tick < 5; ++tick) world.step();
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(world.body(i).velocity.x, i == 4 ? 5 : 0, 1e-9) << i;
      EXPECT_EQ(world.body(i).velocity.y, 0);
    }
    EXPECT_EQ(world.counters().impacts, 4);
  }
}

// Problem 8b. The ball that is hit leaves along the line of centres at the moment of impact.
TEST(ImpactWorld, AnObliqueImpactFollowsItsGeometry) {
  for (const double v : {5 / kTicks, 50 / kTicks, 1e6 / kTicks}) {
    for (const double offset : {0.0, 0.1, 0.5, 0.9, 0.999, -0.7}) {
      ImpactWorld world;
      const int struck = world.add(moving(ball({0.3, 0.1}), {}, 1));
      const int cue = world.add(moving(ball({0.3 - 2.7, 0.1 + offset}), {v, 0}, 1));
      const Place from = world.body(cue).place, to = world.body(struck).place;
      for (double t = 0; t < 4 / v; ++t) world.step();
      const Quad dy = static_cast<Quad>((to - from).y), cosine = sqrtq(1 - dy * dy);
      const double vx = static_cast<double>(v * cosine * cosine), vy = static_cast<double>(v * cosine * dy);
      const double bound = 1e-9 * std::fmax(1, v);
      EXPECT_NEAR(world.body(struck).velocity.x, vx, bound) << v << ' ' << offset;
      EXPECT_NEAR(world.body(struck).velocity.y, vy, bound) << v << ' ' << offset;
      EXPECT_NEAR(world.body(cue).velocity.x, v - vx, bound);
      EXPECT_NEAR(world.body(cue).velocity.y, -vy, bound);
    }
  }
}

// Problem 8c.
TEST(ImpactWorld, GalperinsBilliardCountsTheDigitsOfPi) {
  const std::int64_t digits[] = {3, 31, 314, 3141, 31415};
  for (int k = 0; k <= 4; ++k) {
    for (const bool are_balls : {false, true}) {
      ImpactWorld world;
      world.add(fixed(box({-0.5, 0}, {0.5, 5})));
      const ImpactBody light = are_balls ? ball({2, 0}) : box({2, 0});
      world.add(moving(light, {}, 1));
      ImpactBody heavy = are_balls ? ball({4, 0}) : box({4, 0});
      heavy.inverse_mass = std::pow(100, -k);
      const int id = world.add(moving(heavy, {-0.9, 0}, 1));
      std::int64_t most = 0;
      for (int tick = 0; tick < 40; ++tick) {
        const std::int64_t before = world.counters().impacts;
        EXPECT_EQ(world.step(), ImpactStepStatus::kDone);
        most = std::max(most, world.counters().impacts - before);
      }
      EXPECT_EQ(world.counters().impacts, digits[k]);
      EXPECT_GT(most, k == 4 ? 15000 : 0);
      EXPECT_GT(world.body(id).velocity.x, 0.8 - 0.9 * (k == 0));
    }
  }
}

// Problem 15.
TEST(ImpactWorld, BounceUsesTheRestOfTheTick) {
  for (const double speed : {200 / kTicks, 1e6 / kTicks}) {
    ImpactWorld world;
    world.add(fixed(box({10.5, 0}, {0.5, 5})));
    const int id = world.add(moving(ball({8.3, 0}), {speed, 0}, 1));
    const Quad start = static_cast<Quad>(8.3), wall = static_cast<Quad>(9.5);
    world.step();
    world.step();
    const Quad mirrored = 2 * wall - (start + 2 * static_cast<Quad>(speed));
    EXPECT_NEAR(at(world, id).x, static_cast<double>(mirrored), 1e-9);
    EXPECT_EQ(world.body(id).velocity, (Vec2{-speed, 0}));
  }
}

// Problem 9 for boxes along the axes, and problem 10.
TEST(ImpactWorld, AStackStands) {
  for (const int count : {10, 30, 100}) {
    for (const double friction : {0.0, 0.5}) {
      for (const double heavy : {1.0, 1e4, 1e6}) {
        ImpactWorld world;
        world.add(fixed(box({0, 1}, {5, 1})));
        for (int i = 0; i < count; ++i) {
          ImpactBody body = falling(box({0.01 * (i % 3), -0.5 - i}));
          body.friction = friction;
          if (i == count - 1) body.inverse_mass = 1 / heavy;
          world.add(body);
        }
        for (int tick = 0; tick < 300; ++tick) world.step();
        double worst = 0;
        for (int i = 0; i < count; ++i) {
          worst = std::fmax(worst, std::fabs(at(world, i + 1).y - (-0.5 - i)));
          worst = std::fmax(worst, std::fabs(at(world, i + 1).x - 0.01 * (i % 3)));
        }
        EXPECT_LE(worst, 1e-9) << count << ' ' << friction << ' ' << heavy;
        EXPECT_EQ(world.counters().unconverged, 0);
      }
    }
  }
}

std::vector<int> addStack(ImpactWorld& world, int count, double above) {
  std::vector<int> ids;
  for (int i = 0; i < count; ++i) {
    ImpactBody body = falling(box({0, -0.5 - above - i}));
    body.friction = 0.5;
    ids.push_back(world.add(body));
  }
  world.add(fixed(box({0, 1}, {5, 1})));
  return ids;
}

// The stack is not solved crate by crate. It is made twice, the second time where another stack was.
TEST(ImpactWorld, NewStackIsSolvedOnlyOnce) {
  constexpr int kCount = 100;
  ImpactWorld world;
  world.setReserve(ImpactWorld::kUsualReserve);
  for (int time = 1; time <= 2; ++time) {
    std::vector<int> ids = addStack(world, kCount, 0);
    world.step();
    EXPECT_EQ(world.counters().rest_solves, time);
    EXPECT_EQ(world.events().size(), kCount);
    for (const ImpactEvent& event : world.events()) EXPECT_TRUE(event.is_begin);
    for (int i = 0; i < kCount; ++i) EXPECT_EQ(at(world, ids[i]).y, -0.5 - i);
    world.step();
    EXPECT_TRUE(world.events().empty());
    ids.push_back(kCount);
    for (const int id : ids) world.remove(id);
  }
}

// Each impact on a large stack costs a solution of the whole stack. So the work of a tick is limited by the
// numbers of bodies and events, and the other bodies are abandoned.
TEST(ImpactWorld, TickWorkIsLimitedByBodiesAndEvents) {
  for (const int count : {30, 100, 300}) {
    ImpactWorld world;
    world.setReserve(ImpactWorld::kUsualReserve);
    addStack(world, count, 0.3);
    for (int tick = 0; tick < 30; ++tick) {
      const std::int64_t before = world.counters().impacts;
      world.step();
      const auto impacts = static_cast<double>(world.counters().impacts - before);
      ASSERT_LE(world.work(), 1.1 * (ImpactWorld::kWorkOfTick + ImpactWorld::kWorkOfBody * (count + 1) +
                                     ImpactWorld::kWorkOfEvent * impacts))
          << count << ' ' << tick;
    }
    EXPECT_EQ(world.counters().given_up > 0, count > 30) << count;
  }
}

// Boxes with gaps between them fall on one another and come to rest as a stack.
TEST(ImpactWorld, FallingBoxesComeToRestAsAStack) {
  for (const double restitution : {0.0, 0.3}) {
    ImpactWorld world;
    world.add(fixed(box({0, 1}, {5, 1})));
    for (int i = 0; i < 10; ++i) {
      world.add(falling(moving(box({0, -0.7 - 1.1 * i}), {}, restitution)));
    }
    for (int tick = 0; tick < 600; ++tick) EXPECT_EQ(world.step(), ImpactStepStatus::kDone);
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(at(world, i + 1).y, -0.5 - i, 1e-9) << restitution;
    EXPECT_LT(world.counters().impacts, 100000);
  }
}

// Problem 12. The direction of gravity is tilted instead of the slope.
TEST(ImpactWorld, FrictionHoldsUpToItsAngle) {
  const double threshold = std::atan(0.5);
  for (const double off : {-0.0001, 0.0001}) {  // 0.0057°
    ImpactWorld world;
    ImpactBody ground = fixed(box({0, 1}, {500, 1}));
    ground.friction = 0.5;
    world.add(ground);
    ImpactBody body = box({0, -0.5});
    body.friction = 0.5;
    const double angle = threshold + off;
    body.acceleration = kGravity * Vec2{std::sin(angle), std::cos(angle)};
    const int id = world.add(body);
    for (int tick = 0; tick < 300; ++tick) world.step();
    if (off < 0) {
      EXPECT_NEAR(at(world, id).x, 0, 1e-12);
    } else {
      const double a = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
      EXPECT_NEAR(at(world, id).x / (0.5 * a * 300 * 300), 1, 1e-9);
    }
    EXPECT_NEAR(at(world, id).y, -0.5, 1e-9);
  }
}

TEST(ImpactWorld, SlidingBoxStopsAtTheFrictionDistance) {
  for (const double v : {0.1, 0.37, 3.0}) {
    ImpactWorld world;
    ImpactBody ground = fixed(box({0, 1}, {5000, 1}));
    ground.friction = 0.5;
    world.add(ground);
    ImpactBody body = falling(moving(box({0, -0.5}), {v, 0}));
    body.friction = 0.5;
    const int id = world.add(body);
    for (int tick = 0; tick < 1000; ++tick) world.step();
    EXPECT_NEAR(at(world, id).x / (v * v / (2 * 0.5 * kGravity)), 1, 1e-9);
    EXPECT_EQ(world.body(id).velocity, Vec2{});
  }
}

// A kinematic body carries and pushes other bodies, but these do not push it.
TEST(ImpactWorld, APlatformCarriesAndPushes) {
  ImpactWorld world;
  ImpactBody platform = fixed(box({0, 1}, {5, 1}));
  platform.friction = 1;
  platform.velocity = {0.001, -0.1};  // velocity: slowly to the right, and up
  const int lift = world.add(platform);
  ImpactBody load = falling(box({0, -0.5}));
  load.friction = 1;
  load.velocity = platform.velocity;
  const int id = world.add(load);
  for (int tick = 1; tick <= 100; ++tick) {
    world.step();
    EXPECT_NEAR(at(world, id).y, -0.5 - 0.1 * tick, 1e-9);
    EXPECT_NEAR(at(world, id).x, 0.001 * tick, 1e-9);
  }
  EXPECT_EQ(world.body(lift).velocity, platform.velocity);
  platform.place = world.body(lift).place;
  platform.velocity = {};
  world.set(lift, platform);  // the platform stops, and its load continues upwards
  world.step();
  EXPECT_LT(world.body(id).velocity.y, -0.08);
}

// Seams between tiles neither stop nor slow a sliding body, at any speed.
TEST(ImpactWorld, TileSeamsDoNotDisturbSliding) {
  for (const bool is_ball : {false, true}) {
    for (const double v : {0.013, 0.3, 7.0}) {
      ImpactWorld world;
      for (int i = 0; i < 40; ++i) world.add(fixed(box({i + 0.1, 0.3}, {0.5, 0.5})));
      const int id = world.add(falling(moving(is_ball ? ball({1, -0.7}) : box({1, -0.7}), {v, 0}, 0.5)));
      const int ticks = static_cast<int>(35 / v);
      for (int tick = 0; tick < ticks; ++tick) world.step();
      EXPECT_NEAR(at(world, id).x, 1 + v * ticks, 1e-9) << is_ball << v;
      EXPECT_NEAR(at(world, id).y, -0.7, 1e-9) << is_ball << v;
    }
  }
}

// A box slides over a table's edge and flies from there, on the parabola that starts at the edge.
TEST(ImpactWorld, BoxLeavesTheTableExactlyAtItsEdge) {
  ImpactWorld world;
  world.add(fixed(box({0, 1}, {2, 1})));
  const int id = world.add(falling(moving(box({0, -0.5}), {0.3, 0})));
  for (int tick = 0; tick < 20; ++tick) world.step();
  const double flight = 20 - 2.5 / 0.3;
  EXPECT_NEAR(at(world, id).y, -0.5 + 0.5 * kGravity * flight * flight, 1e-9);
  EXPECT_NEAR(at(world, id).x, 6, 1e-12);
}

TEST(ImpactWorld, ReportsWhenContactsBeginAndEnd) {
  ImpactWorld world;
  const int wall = world.add(fixed(box({10, 0}, {1, 5})));
  ImpactBody body = moving(box({8, 0}), {0.8, 0}, 0.5);
  body.inverse_mass = 0.5;
  const int id = world.add(body);
  world.step();
  ASSERT_EQ(world.events().size(), 2U);
  const ImpactEvent begin = world.events()[0], end = world.events()[1];
  EXPECT_TRUE(begin.is_begin);
  EXPECT_FALSE(end.is_begin);
  EXPECT_EQ(begin.first, wall);
  EXPECT_EQ(begin.second, id);
  EXPECT_NEAR(begin.time, 0.5 / 0.8, 1e-15);
  EXPECT_EQ(end.time, begin.time);
  EXPECT_NEAR(begin.impulse, 2 * 0.8 * 1.5, 1e-12);
  EXPECT_EQ(begin.normal, (Vec2{-1, 0}));
  world.step();
  EXPECT_TRUE(world.events().empty());

  ImpactWorld resting;  // of a box that rests: its contact begins once, and ends when it is lifted
  resting.add(fixed(box({0, 1}, {5, 1})));
  const int lying = resting.add(falling(box({0, -0.6})));
  int begun = 0, ended = 0;
  for (int tick = 0; tick < 60; ++tick) {
    if (tick == 40) resting.set(lying, moving(resting.body(lying), {0, -0.01}));
    resting.step();
    for (const ImpactEvent& event : resting.events()) ++(event.is_begin ? begun : ended);
    if (tick == 39) {
      EXPECT_EQ(begun - ended, 1);
    }
  }
  EXPECT_EQ(begun, 2);  // the box falls back, which begins a second contact
  EXPECT_EQ(ended, 1);
}

// A ball lies on two others. Each force is along a line of centres, until the lower balls slide apart.
TEST(ImpactWorld, BallOnTwoBallsRestsOrPartsThem) {
  for (const bool is_held : {true, false}) {
    ImpactWorld world;
    world.add(fixed(box({0, 1}, {50, 1})));
    ImpactBody left = falling(ball({-0.6, -0.5})), right = falling(ball({0.6, -0.5}));
    if (is_held) {
      left = fixed(left);
      right = fixed(right);
      left.acceleration = right.acceleration = {};
    }
    world.add(left);
    world.add(right);
    const double height = 0.5 + std::sqrt(1 - 0.36);
    const int id = world.add(falling(ball({0, -height})));
    for (int tick = 0; tick < 10; ++tick) world.step();
    if (is_held) {
      EXPECT_NEAR(at(world, id).y, -height, 1e-9);
    } else {
      // Without friction and bounces, the upper ball's loss of potential energy became kinetic energy.
      double energy = 0;
      for (int i = 1; i <= 3; ++i) energy += 0.5 * lengthSquared(world.body(i).velocity);
      // The force keeps its direction between events, so the error is of first order.
      EXPECT_NEAR(energy / (kGravity * (at(world, id).y + height)), 1, 3e-2);
      EXPECT_GT(at(world, 2).x, 0.7);
      EXPECT_NEAR(at(world, 1).x, -at(world, 2).x, 1e-9);
    }
  }
}

// A body deep inside an immovable one leaves it through the nearest face, without a bounce.
TEST(ImpactWorld, BallInsideAWallIsPushedOut) {
  for (const double restitution : {0.0, 0.12, 1.0}) {
    for (const double speed : {0.3, -0.3, 0.0}) {
      ImpactWorld world;
      world.add(fixed(box({0, 43}, {60, 3})));
      ImpactBody body = falling(moving(ball({-22.6, 43.2}, 1.144), {0.01, speed}, restitution));
      body.friction = 0.5;
      const int id = world.add(body);
      for (int tick = 0; tick < 60; ++tick) world.step();
      EXPECT_FALSE(world.isFrozen(id));
      EXPECT_LE(world.counters().impacts, 1);
      EXPECT_GT(at(world, id).y, 47.1);
    }
  }
}

// The step ends when an impact sends a body out of the area of setReach().
TEST(ImpactWorld, StepEndsWhereTheSearchedReachEnds) {
  ImpactWorld world;
  world.add(moving(ball({-2, 0}), {3, 0}, 1));
  const int struck = world.add(ball({0, 0}));
  world.setReach(struck, placeAt({0, 0}), {1, 1});
  world.step();
  EXPECT_NEAR(world.stepped(), 1 / 3.0, 1e-12);
  EXPECT_NEAR(world.body(struck).velocity.x, 3, 1e-12);
  EXPECT_NEAR(at(world, struck).x, 0, 1e-12);
  world.step(1 - world.stepped());  // a reach is only valid for one step
  EXPECT_NEAR(at(world, struck).x, 2, 1e-12);
}

}  // namespace
}  // namespace naiad::physics
