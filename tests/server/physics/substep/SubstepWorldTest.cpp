// Bodies in a SubstepWorld: they rest, sleep, wake, push, bounce and have events.

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "SubstepScene.h"

namespace naiad::physics {
namespace {

using namespace test;

// There are more contacts than in one batch, but none is missed.
TEST(SubstepWorld, SixHundredStacksStandTouchOnceAndSleep) {
  constexpr int kStacks = 600;
  SubstepScene scene;
  scene.addFloor();
  std::vector<int> tops;
  for (int i = 0; i < kStacks; ++i) {
    const double x = 2.0 * (i - kStacks / 2);
    scene.addCrate({x, -0.6});
    tops.push_back(scene.addCrate({x, -1.7}));
  }
  std::size_t begun = 0;
  for (int tick = 0; tick < 100; ++tick) {
    scene.ticks(1);
    begun += scene.world.events().size();
  }
  EXPECT_EQ(begun, 2u * kStacks);
  for (const int top : tops) {
    EXPECT_TRUE(scene.world.isAsleep(top)) << top;
    EXPECT_NEAR(scene.at(top).y, -1.5, 0.01) << top;
  }
}

// The slow swings of a pile are damped, and it does not creep to a side.
TEST(SubstepWorld, TallPyramidOfTouchingBoxesComesToRest) {
  constexpr int kRows = 20;
  SubstepScene scene;
  scene.addFloor();
  std::vector<int> ids;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i) ids.push_back(scene.addCrate({i + 0.5 * row, -0.5 - row}));
  }
  scene.ticks(75);
  for (const int id : ids) EXPECT_TRUE(scene.world.isAsleep(id)) << id;
  EXPECT_NEAR(scene.at(ids.back()).y, 0.5 - kRows, 0.1);
  EXPECT_NEAR(scene.at(ids.back()).x, 0.5 * (kRows - 1), 0.05);
}

// The body is placed on three light ones, at different positions on the top one.
TEST(SubstepWorld, HeaviestBodyPressesNothingThroughTheFloor) {
  for (double off = 0; off < 0.5; off += 0.0127) {
    SubstepScene scene;
    scene.add(immovable({0, 0.5}), boxShape(50, 0.5));
    std::vector<int> ids;
    for (int i = 0; i < 3; ++i) ids.push_back(scene.addCrate({0, -0.5 - i}));
    const ConvexShape shape = boxShape(0.5, 0.5);
    ids.push_back(scene.add(movable({off, -3.51}, shape, 1e12), shape));
    const auto lowest = [&] { return scene.largest(ids, [&](int id) { return scene.at(id).y; }); };
    EXPECT_LT(scene.most(150, lowest), 0.5) << off;
  }
}

// Bodies without contacts sleep if they are at rest except for rounding; drifting ones continue.
TEST(SubstepWorld, FloatingBodiesSleepAtRestDriftingOnesDoNot) {
  for (const double drift : {0.0, 1e-9}) {
    SubstepScene scene;
    const ConvexShape shape = boxShape(0.2, 0.2);
    for (int i = 0; i < 36; ++i) {
      scene.add(floating({30 + 0.4 * (i / 6), 0.4 * (i % 6 - 2.5)}, shape, {drift, 0}), shape);
    }
    scene.world.setSleeping(false);
    scene.ticks(2);
    double fastest = 0;
    for (int id = 0; id < 36; ++id) fastest = std::max(fastest, scene.speed(id));
    EXPECT_GT(fastest, 0);
    scene.world.setSleeping(true);
    scene.ticks(38);
    for (int id = 0; id < 36; ++id) EXPECT_EQ(scene.world.isAsleep(id), drift == 0) << id;
  }
}

// A body with gravity does not sleep at once, nor does one that has just been woken.
TEST(SubstepWorld, BodyStartedAtRestWithoutGravitySleepsAtOnce) {
  SubstepScene scene;
  const ConvexShape shape = boxShape(0.2, 0.2);
  RigidBody body = movable({0, 0}, shape);
  const int falling = scene.add(body, shape);
  body.acceleration = {};
  body.place = placeAt({3, 0});
  const int floating = scene.add(body, shape);
  body.place = placeAt({1, 0});
  body.velocity = {0.7, 0};
  const int flying = scene.add(body, shape);
  scene.ticks(1);
  EXPECT_FALSE(scene.world.isAsleep(falling) || scene.world.isAsleep(flying));
  EXPECT_TRUE(scene.world.isAsleep(floating));
  scene.ticks(2);
  EXPECT_FALSE(scene.world.isAsleep(floating));
  EXPECT_GT(scene.speed(floating), 0.1);
  body = scene.world.body(floating);
  body.velocity = {};
  body.spin = 0;
  scene.world.set(floating, body);
  RigidBody away = scene.world.body(flying);
  away.place = placeAt({30, 0});
  scene.world.set(flying, away);
  scene.ticks(10);
  EXPECT_FALSE(scene.world.isAsleep(floating));
  scene.ticks(10);
  EXPECT_TRUE(scene.world.isAsleep(floating));
}

TEST(SubstepWorld, SleepingCanBeSwitchedOff) {
  SubstepScene scene;
  scene.addFloor();
  const int crate = scene.addCrate({0, -0.5}), other = scene.addCrate({5, -0.5});
  scene.ticks(60);
  ASSERT_TRUE(scene.world.isAsleep(crate) && scene.world.isAsleep(other));
  scene.world.setSleeping(false);
  EXPECT_FALSE(scene.world.isAsleep(crate) || scene.world.isAsleep(other));
  for (int tick = 0; tick < 60; ++tick) {
    scene.ticks(1);
    ASSERT_FALSE(scene.world.isAsleep(crate) || scene.world.isAsleep(other)) << tick;
  }
  scene.world.setSleeping(true);
  scene.ticks(60);
  EXPECT_TRUE(scene.world.isAsleep(crate) && scene.world.isAsleep(other));
}

// While a pile comes to rest, each pair has at most one more begin than ends. At rest, there are no more
// events.
TEST(SubstepWorld, AContactBeginsOnceAndEndsOnce) {
  SubstepScene scene(awake());
  const int floor = scene.addFloor();
  const int lower = scene.addCrate({0, -0.5}), upper = scene.addCrate({0.2, -1.5});
  std::vector<RigidEvent> events;
  const auto go = [&](int n) {
    events.clear();
    for (int tick = 0; tick < n; ++tick) {
      scene.ticks(1);
      events.insert(events.end(), scene.world.events().begin(), scene.world.events().end());
    }
  };
  go(200);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_TRUE(events[0].is_begin && events[1].is_begin);
  EXPECT_GT(events[0].impulse, 0);
  for (const RigidEvent& event : events) {
    EXPECT_LT(event.first, event.second);
    const bool is_with_floor = event.first == floor;
    EXPECT_EQ(event.second, is_with_floor ? lower : upper);
    EXPECT_NEAR(event.normal.y, -1, 1e-6);  // towards `second`, which lies above
  }
  scene.setVelocity(upper, {0, -0.5});
  go(20);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_FALSE(events[0].is_begin);
  EXPECT_EQ(std::pair(events[0].first, events[0].second), std::pair(lower, upper));
}

// The body slides along the floor without pressure. This is one contact, until the body leaves the floor.
TEST(SubstepWorld, ContactLastsWithoutPressure) {
  SubstepScene scene(awake());
  scene.addFloor();
  const ConvexShape crate = boxShape(0.5, 0.5);
  RigidBody body = floating({0, -0.6}, crate, {0.05, 0.04});
  body.friction = 0;
  const int id = scene.add(body, crate);
  std::size_t begun = 0;
  for (int tick = 0; tick < 100; ++tick) {
    scene.ticks(1);
    for (const RigidEvent& event : scene.world.events()) {
      EXPECT_TRUE(event.is_begin) << tick;
      ++begun;
    }
  }
  EXPECT_EQ(begun, 1U);
  EXPECT_NEAR(scene.world.body(id).velocity.x, 0.05, 1e-6);
  EXPECT_NEAR(scene.world.body(id).velocity.y, 0, 1e-6);
}

TEST(SubstepWorld, TouchedBodyWakesWithItsGroup) {
  SubstepScene scene;
  scene.addFloor();
  std::vector<int> stack;
  for (int i = 0; i < 4; ++i) stack.push_back(scene.addCrate({0, -0.5 - i}));
  const int apart = scene.addCrate({20, -0.5});
  scene.ticks(90);
  for (const int id : stack) ASSERT_TRUE(scene.world.isAsleep(id)) << id;
  RigidBody ball = movable({-3, -0.5}, circleShape(0.3));
  ball.velocity = {0.4, 0};
  const int id = scene.add(ball, circleShape(0.3));
  int ticks = 0;
  while (scene.world.isAsleep(stack[0]) && ticks++ < 20) scene.ticks(1);
  for (const int member : stack) EXPECT_FALSE(scene.world.isAsleep(member)) << member;
  EXPECT_TRUE(scene.world.isAsleep(apart));
  scene.world.remove(id);
}

TEST(SubstepWorld, KinematicBodyPushes) {
  SleepingCrate scene;
  RigidBody piston = immovable({-3, -0.6});
  piston.velocity = {0.1, 0};
  const int mover = scene.add(piston, boxShape(0.5, 0.5));
  scene.ticks(60);
  EXPECT_EQ(scene.at(mover).x, -3 + 0.1 * 60);
  EXPECT_NEAR(scene.at(scene.crate).x - scene.at(mover).x, 1, 0.02);
  EXPECT_NEAR(scene.world.body(scene.crate).velocity.x, 0.1, 0.02);
  EXPECT_FALSE(scene.world.isAsleep(scene.crate));
}

// A platform carries the crate by friction. The crate does not sleep, because the platform moves.
TEST(SubstepWorld, MovingPlatformCarriesTheCrate) {
  SubstepScene scene;
  const int carrier = scene.add(immovable({0, 0.5}), boxShape(4, 0.5));
  const int crate = scene.addCrate({0, -0.5});
  scene.ticks(60);
  ASSERT_TRUE(scene.world.isAsleep(crate));
  scene.setVelocity(carrier, {0.05, 0});
  scene.ticks(100);
  EXPECT_FALSE(scene.world.isAsleep(crate));
  EXPECT_NEAR(scene.at(crate).x, scene.at(carrier).x, 0.5);
  EXPECT_NEAR(scene.world.body(crate).velocity.x, 0.05, 1e-3);
  scene.setVelocity(carrier, {5e-4, 0});  // slower than the sleep speed
  scene.ticks(30);
  const double start = scene.at(crate).x;
  scene.ticks(100);
  EXPECT_FALSE(scene.world.isAsleep(crate));
  EXPECT_NEAR(scene.at(crate).x - start, 0.05, 1e-3);
}

TEST(SubstepWorld, ElasticBallReturnsToItsHeight) {
  for (const double height : {3.0, 4.3, 5.0, 5.7, 9.1}) {
    SubstepScene scene;
    scene.addFloor();
    RigidBody ball = movable({0, -0.5 - height}, circleShape(0.5));
    ball.restitution = 1;
    const int id = scene.add(ball, circleShape(0.5));
    int ticks = 0;
    while (scene.world.body(id).velocity.y >= 0 && ticks++ < 200) scene.ticks(1);
    double top = 0;
    while (scene.world.body(id).velocity.y < 0 && ticks++ < 200) {
      scene.ticks(1);
      top = std::max(top, -0.5 - scene.at(id).y);
    }
    EXPECT_NEAR(top / height, 1, 0.08) << height;
  }
}

TEST(SubstepWorld, RestitutionHalfKeepsHalfTheSpeed) {
  SubstepScene scene;
  scene.add(immovable({10, 0}), boxShape(1, 5));
  RigidBody body = floating({5, 0}, circleShape(0.5), {0.4, 0});
  body.restitution = 0.5;
  const int id = scene.add(body, circleShape(0.5));
  scene.ticks(40);
  EXPECT_NEAR(scene.world.body(id).velocity.x, -0.2, 0.002);
}

TEST(SubstepWorld, FrictionHoldsUpToItsAngle) {
  for (const double off : {-1.0, 1.0}) {
    SubstepScene scene(awake());
    const double angle = std::atan(0.5) + off * std::numbers::pi / 180;
    const int id = addCrateOnSlope(scene, angle, addSlope(scene, angle));
    scene.ticks(120);
    const double expected = kGravityPerTick * (std::sin(angle) - 0.5 * std::cos(angle)) * 120;
    if (off < 0) {
      EXPECT_LT(scene.speed(id), 1e-4);
    } else {
      EXPECT_NEAR(scene.speed(id) / expected, 1, 0.05);
    }
  }
}

// Twenty bodies in free space that fly at each other, some with a hinge; returns by how much momentum and
// angular momentum changed in any tick, as parts of the sums of their amounts.
std::pair<double, double> momentumLost(double speed, Vec2 gravity, double friction, bool has_hinges) {
  SubstepScene scene(awake());
  const ConvexShape crate = boxShape(0.5, 0.5), disc = circleShape(0.5);
  std::vector<int> ids;
  for (int i = 0; i < 20; ++i) {
    const ConvexShape& shape = i % 2 == 0 ? crate : disc;
    const Vec2 velocity =
        Vec2{-0.05 * (i % 5 - 2), -0.05 * (i / 5 - 1.5)} + Vec2{0.01 * (i % 3), 0.01 * (i % 7)};
    RigidBody body = floating({1.3 * (i % 5), 1.3 * (i / 5)}, shape, speed * velocity, 1 + i % 3);
    body.restitution = 0.5;
    body.friction = friction;
    body.acceleration = gravity;
    ids.push_back(scene.add(body, shape));
    if (has_hinges && i % 5 == 3)
      scene.join({}, JointKind::kHinge, ids[at(i - 1)], ids[at(i)], {0.65, 0}, {-0.65, 0});
  }
  const auto sums = [&] {
    double mass = 0, turning = 0, amount = 0, turning_amount = 0;
    Vec2 path, momentum;
    for (const int id : ids) {
      const RigidBody& b = scene.world.body(id);
      const double m = 1 / b.inverse_mass;
      mass += m;
      path += m * scene.at(id);
      momentum += m * b.velocity;
      amount += m * length(b.velocity);
    }
    for (const int id : ids) {
      const RigidBody& b = scene.world.body(id);
      const double own = b.spin / b.inverse_inertia;
      const double around = cross(scene.at(id) - path / mass, b.velocity - momentum / mass) / b.inverse_mass;
      turning += own + around;
      turning_amount += std::abs(own) + std::abs(around);
    }
    return std::tuple(momentum, amount, turning, turning_amount, mass);
  };
  const auto [momentum, amount, turning, turning_amount, mass] = sums();
  double lost = 0, lost_turning = 0;
  for (int tick = 1; tick <= 200; ++tick) {
    scene.ticks(1);
    const auto [now, amount_now, turning_now, turning_amount_now, mass_now] = sums();
    lost = std::max(lost, length(now - momentum - (tick * mass) * gravity) / std::max(amount, amount_now));
    lost_turning = std::max(lost_turning,
                            std::abs(turning_now - turning) / std::max(turning_amount, turning_amount_now));
  }
  EXPECT_GT(scene.world.counters().contacts, 20);
  return {lost, lost_turning};
}

TEST(SubstepWorld, FreeGroupsKeepTheirMomentum) {
  for (const double speed : {0.3, 1.0, 4.0}) {
    for (const Vec2 gravity : {Vec2{}, Vec2{0, 0.02}}) {
      for (const double friction : {0.0, 0.6}) {
        for (const bool has_hinges : {false, true}) {
          SCOPED_TRACE(testing::Message()
                       << speed << ' ' << gravity.y << ' ' << friction << ' ' << has_hinges);
          const auto [lost, lost_turning] = momentumLost(speed, gravity, friction, has_hinges);
          EXPECT_LE(lost, 1e-11);
          // A hinge that closes a gap moves momentum along a lever.
          EXPECT_LE(lost_turning, has_hinges ? 1e-6 : 1e-8);
        }
      }
    }
  }
}

TEST(SubstepWorld, APileGainsNoEnergy) {
  SubstepScene scene(awake());
  scene.addFloor();
  const ConvexShape crate = boxShape(0.5, 0.4), disc = circleShape(0.45);
  std::vector<int> ids;
  for (int i = 0; i < 40; ++i) {
    const ConvexShape& shape = i % 3 == 0 ? disc : crate;
    RigidBody body = movable({1.2 * (i % 7) + 0.1 * (i % 2), -1 - 1.3 * (i / 7)}, shape);
    body.rotation = rotationBy(0.3 * i);
    ids.push_back(scene.add(body, shape));
  }
  const auto energy = [&] {
    double sum = 0;
    for (const int id : ids) sum += energyOf(scene.world.body(id));
    return sum;
  };
  const double start = energy();
  EXPECT_LE(scene.most(300, energy), start * (1 + 1e-3));
  EXPECT_LT(energy(), 0.5 * start);  // the pile has collapsed
  EXPECT_LT(scene.world.deepest(), 0.03);
}

TEST(SubstepWorld, NonFiniteNumbersAreRefused) {
  SubstepScene scene;
  RigidBody body = movable({0, 0}, circleShape(1));
  body.velocity.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene.add(body, circleShape(1)), -1);
  body.velocity.x = 0;
  const int id = scene.add(body, circleShape(1));
  ASSERT_GE(id, 0);
  body.spin = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(scene.world.set(id, body));
  EXPECT_EQ(scene.world.body(id).spin, 0);
  EXPECT_EQ(scene.world.counters().ticks, 0);
}

TEST(SubstepWorld, ExcessiveAccelerationFreezesTheBodyAlone) {
  SubstepScene scene;
  scene.addFloor();
  const int crate = scene.addCrate({0, -0.5}), above = scene.addCrate({0, -1.5});
  RigidBody body = movable({0, -2.5}, circleShape(0.5));
  const Vec2 gravity = std::exchange(body.acceleration, {1e30, 0});
  const int poisoned = scene.add(body, circleShape(0.5));
  scene.world.step();
  EXPECT_TRUE(scene.world.isFrozen(poisoned));
  EXPECT_EQ(scene.world.counters().quarantined, 1);
  const Vec2 place = scene.at(poisoned);
  scene.ticks(90);
  EXPECT_EQ(scene.at(poisoned), place);
  EXPECT_FALSE(scene.world.isFrozen(crate) || scene.world.isFrozen(above));
  EXPECT_NEAR(scene.at(above).y, -1.5, 5e-3);
  body.acceleration = gravity;
  ASSERT_TRUE(scene.world.set(poisoned, body));
  EXPECT_FALSE(scene.world.isFrozen(poisoned));
  scene.ticks(90);
  EXPECT_NEAR(scene.at(poisoned).y, -2.5, 1e-2);
}

TEST(SubstepWorld, IdsAreReused) {
  SubstepScene scene;
  scene.addFloor();
  const int first = scene.addCrate({0, -0.5}), second = scene.addCrate({0, -1.5});
  scene.ticks(60);
  ASSERT_TRUE(scene.world.remove(first));
  EXPECT_FALSE(scene.world.exists(first));
  EXPECT_FALSE(scene.world.remove(first));
  scene.ticks(1);
  EXPECT_TRUE(scene.world.events().empty());  // the contacts of the removed body end without an event
  const int third = scene.addCrate({10, -3});
  EXPECT_EQ(third, first);
  const int limit = scene.world.idLimit();
  scene.ticks(90);
  EXPECT_NEAR(scene.at(second).y, -0.5, 1e-2);
  EXPECT_NEAR(scene.at(third).y, -0.5, 1e-2);
  for (int i = 0; i < 50; ++i) {
    const int id = scene.addCrate({20, -3});
    scene.ticks(1);
    scene.world.remove(id);
    scene.ticks(1);
  }
  EXPECT_LE(scene.world.idLimit(), limit + 1);
}

constexpr double kHalf = 0.125;  // half the width of a box
constexpr double kRadius = 6;    // distance of the middle of each wall from the drum's centre
constexpr double kDrumTurn = 0.05 * 2 * std::numbers::pi / 30;  // rad per tick: a revolution in 20 s

// Adds a square drum as body 0, which rotates about the origin.
void addDrum(SubstepScene& scene) {
  std::vector<ConvexShape> walls(4);
  makeBox(kRadius + 0.5, 0.5, {0, kRadius}, {}, 0, walls[0]);
  makeBox(kRadius + 0.5, 0.5, {0, -kRadius}, {}, 0, walls[1]);
  makeBox(0.5, kRadius + 0.5, {kRadius, 0}, {}, 0, walls[2]);
  makeBox(0.5, kRadius + 0.5, {-kRadius, 0}, {}, 0, walls[3]);
  RigidBody drum = immovable({});
  drum.spin = kDrumTurn;
  scene.world.addInOrder(++scene.order, drum, walls);
}

TEST(SubstepWorld, TurningDrumKeepsItsBoxesInside) {
  SubstepOptions options = awake();
  options.searches = 2, options.substeps = 5;  // as at ACCURACY_DEFAULT
  SubstepScene scene(options);
  addDrum(scene);
  constexpr int kBoxes = 150;
  for (int i = 0; i < kBoxes; ++i) {
    scene.addCrate({0.35 * (i % 15 - 7), 0.35 * (i / 15 - 5)}, kHalf);
  }
  double deepest = 0, sum = 0, fastest = 0;
  constexpr int kTicks = 240, kFallen = 40;
  for (int tick = 0; tick < kTicks; ++tick) {
    scene.ticks(1);
    for (int id = 1; id <= kBoxes; ++id) {
      fastest = std::max(fastest, scene.speed(id));
      const Vec2 inside = inverse(scene.world.body(0).rotation) * scene.at(id);
      ASSERT_LT(std::max(std::fabs(inside.x), std::fabs(inside.y)), kRadius) << id << ' ' << tick;
    }
    if (tick < kFallen) continue;
    deepest = std::max(deepest, scene.world.deepest());
    sum += scene.world.deepest();
  }
  EXPECT_LT(deepest, 0.3 * 2 * kHalf);  // like Box2D with four times the steps: 0.076 of 0.25
  EXPECT_LT(sum / (kTicks - kFallen), 0.1 * 2 * kHalf);
  EXPECT_LT(fastest, std::sqrt(2 * kGravityPerTick * 4 * kRadius));  // no box is thrown
}

}  // namespace
}  // namespace naiad::physics
