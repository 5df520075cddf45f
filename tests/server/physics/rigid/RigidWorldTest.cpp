// Properties of rigid bodies. The bounds are targets of the laboratory (docs/physics/lab.md).

#include <limits>

#include "RigidScene.h"
#include "tests/server/physics/BitHash.h"
#include "tests/server/physics/RandomShapes.h"
#include "tests/server/physics/SceneRandom.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr double kDegree = std::numbers::pi / 180;

TEST(RigidWorld, FrictionHoldsUpToItsAngle) {
  for (const double off : {-0.01, 0.01}) {
    RigidWorld world(sleepless());
    const double angle = std::atan(0.5) + off * kDegree;
    const int id = addCrateOnSlope(world, angle, addSlope(world, angle));
    for (int tick = 0; tick < 120; ++tick) world.step();
    EXPECT_EQ(30 * length(world.body(id).velocity) > 1e-3, off > 0) << off;
  }
}

TEST(RigidWorld, SlidingAndRollingMatchTheFormulas) {
  RigidWorld slides(sleepless()), rolls(sleepless());
  const double steep = 40 * kDegree, angle = 30 * kDegree;
  const Vec2 steep_up = addSlope(slides, steep), up = addSlope(rolls, angle);
  const int crate = addCrateOnSlope(slides, steep, steep_up);
  const ConvexShape disc = circleShape(0.5);
  const int id = rolls.add(movable(0.5 * up, disc), disc);
  for (int tick = 0; tick < 60; ++tick) slides.step(), rolls.step();
  const double displacement = length(whereIs(slides, crate) - 0.25 * steep_up);
  EXPECT_NEAR(displacement / (2 * 10 * (std::sin(steep) - 0.5 * std::cos(steep))), 1, 1e-9);
  EXPECT_NEAR(length(whereIs(rolls, id) - 0.5 * up) / (10 * std::sin(angle) * 4 / 3), 1, 1e-9);
  EXPECT_NEAR(length(rolls.body(id).velocity), 0.5 * std::fabs(rolls.body(id).spin), 1e-12);
}

TEST(RigidWorld, TumblingElasticBoxKeepsItsEnergy) {
  RigidWorld world;
  RigidBody floor = immovable({0, 5});
  floor.restitution = 1;
  floor.friction = 0;
  world.add(floor, boxShape(1000, 5));
  const ConvexShape crate = boxShape(0.5, 0.25);
  RigidBody box = movable({0, -5.5}, crate);
  box.friction = 0;
  box.spin = 0.1;
  box.rotation = rotationBy(0.3);
  const int id = world.add(box, crate);
  const double before = energyOf(world.body(id));
  for (int tick = 0; tick < 900; ++tick) {
    world.step();
    ASSERT_NEAR(energyOf(world.body(id)) / before, 1, 1e-12) << tick;
    ASSERT_LT(whereIs(world, id).y, -0.24) << tick;
  }
  EXPECT_GT(world.counters().impacts, 20);
}

// Sums over some bodies. Each scale is the sum of the parts' absolute values.
struct Motion {
  double energy = 0;
  Vec2 momentum;
  double momentum_scale = 0, angular = 0, angular_scale = 0;
};

Motion motionOf(const RigidWorld& world, int first, int last) {
  Motion sum;
  for (int id = first; id <= last; ++id) {
    const RigidBody& body = world.body(id);
    const double mass = 1 / body.inverse_mass, inertia = 1 / body.inverse_inertia;
    const double turning = inertia * body.spin, around = mass * cross(whereIs(world, id), body.velocity);
    sum.energy += 0.5 * (mass * lengthSquared(body.velocity) + turning * body.spin);
    sum.momentum += mass * body.velocity;
    sum.momentum_scale += mass * length(body.velocity);
    sum.angular += around + turning;
    sum.angular_scale += mass * length(whereIs(world, id)) * length(body.velocity) + std::fabs(turning);
  }
  return sum;
}

ConvexShape anyConvexShape(SplitMix64& random, int kind) {
  ConvexShape shape;
  const double first = between(random, 0.3, 1), second = between(random, 0.3, 1);
  if (kind == 0) return circleShape(first);
  if (kind == 1) return boxShape(first, second);
  do {
    std::vector<Vec2> points;
    for (int i = 0; i < 8; ++i) points.push_back(anyVec(random, 1));
    EXPECT_EQ(makePolygon(hullOf(points), 0, shape), ShapeStatus::kOk);
  } while (shape.count == 0);
  // The centre of mass is the origin.
  const Vec2 centre = massOf(shape, 1).centre;
  return moved(shape, {}, -centre);
}

RigidBody elastic(SplitMix64& random, Vec2 where, const ConvexShape& shape, Vec2 velocity, double mass) {
  RigidBody body = floating(where, shape, velocity, mass);
  body.friction = 0;
  body.restitution = 1;
  body.rotation = anyRotation(random);
  return body;
}

TEST(RigidWorld, ElasticImpactsKeepEnergyAndMomentum) {
  SplitMix64 random(3);
  int met = 0;
  for (int trial = 0; trial < 600; ++trial) {
    RigidWorld world(sleepless());
    const double speed = 0.03 * std::pow(1000.0, random.unit());
    const double heavy = trial % 4 == 0 ? std::pow(10.0, 9 * random.unit()) : between(random, 0.5, 2);
    const Vec2 start = {4 + between(random, 0, 2 * speed), between(random, -0.7, 0.7)};
    const int kind_a = static_cast<int>(3 * random.unit()), kind_b = static_cast<int>(3 * random.unit());
    const ConvexShape shape_a = anyConvexShape(random, kind_a), shape_b = anyConvexShape(random, kind_b);
    RigidBody a = elastic(random, {}, shape_a, 0.1 * anyVec(random, speed), heavy);
    RigidBody b = elastic(random, start, shape_b, {-speed, 0}, 1);
    if (trial % 3 > 0) a.spin = between(random, -0.5, 0.5), b.spin = between(random, -0.5, 0.5);
    world.add(a, shape_a);
    world.add(b, shape_b);
    const Motion before = motionOf(world, 0, 1);
    const double most = kind_a + kind_b == 0 ? 1e-9 : 1e-6;
    const int ticks = std::min(400, static_cast<int>(10 / speed) + 4);
    for (int tick = 0; tick < ticks; ++tick) {
      world.step();
      const Motion now = motionOf(world, 0, 1);
      ASSERT_NEAR(now.energy / before.energy, 1, most) << trial << " tick " << tick;
      ASSERT_LE(length(now.momentum - before.momentum), 1e-9 * before.momentum_scale) << trial;
      ASSERT_LE(std::fabs(now.angular - before.angular), 1e-9 * now.angular_scale) << trial;
    }
    met += world.counters().impacts > 0 ? 1 : 0;
  }
  EXPECT_GT(met, 300);
}

// An hour (108,000 ticks) keeps the energy to 1e-9 as well.
TEST(RigidWorld, ElasticBodiesInARoomKeepTheirEnergy) {
  for (const int count : {2, 10, 25}) {
    SplitMix64 random(static_cast<std::uint64_t>(count));
    RigidWorld world;
    const double half = 2 + 1.5 * std::sqrt(static_cast<double>(count));
    for (const Vec2 side : {Vec2{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      RigidBody wall = immovable((half + 1) * side);
      wall.friction = 0;
      world.add(wall, side.x != 0 ? boxShape(1, half + 2) : boxShape(half + 2, 1));
    }
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    for (int i = 0; i < count; ++i) {
      const Vec2 where = Vec2{3.0 * (i % columns), 3.0 * (i / columns)} - 1.5 * (columns - 1) * Vec2{1, 1};
      const ConvexShape shape = anyConvexShape(random, i % 3);
      RigidBody body = elastic(random, where, shape, anyVec(random, i % 5 == 0 ? 3 : 0.3), 1 + i % 4);
      body.spin = between(random, -0.3, 0.3);
      world.add(body, shape);
    }
    const Motion before = motionOf(world, 4, 3 + count);
    for (int tick = 0; tick < 3000; ++tick) world.step();
    const Motion after = motionOf(world, 4, 3 + count);
    EXPECT_NEAR(after.energy / before.energy, 1, 1e-9) << count;
    EXPECT_GT(world.counters().impacts, 100 * count);
    for (int id = 4; id < 4 + count; ++id) {
      EXPECT_LT(std::max(std::fabs(whereIs(world, id).x), std::fabs(whereIs(world, id).y)), half) << count;
    }
  }
}

TEST(RigidWorld, MomentumIsConserved) {
  RigidWorld world(sleepless());
  const ConvexShape crate = boxShape(0.5, 0.5);
  for (int i = 0; i < 100; ++i) {
    RigidBody body = floating({1.2 * (i % 10), 1.2 * (i / 10)}, crate,
                              {0.05 * ((i * 7) % 11 - 5), 0.05 * ((i * 5) % 13 - 6)}, 1 + i % 3);
    body.restitution = 0.5;
    world.add(body, crate);
  }
  const auto momentum = [&] {
    Vec2 sum;
    for (int i = 0; i < 100; ++i) sum += world.body(i).velocity / world.body(i).inverse_mass;
    return sum;
  };
  const Vec2 before = momentum();
  for (int tick = 0; tick < 1000; ++tick) world.step();
  EXPECT_GT(world.counters().contacts, 1000);
  EXPECT_LE(length(momentum() - before), 1e-12 * 100);
}

std::uint64_t hashOf(const RigidWorld& world, const Place& origin, int count) {
  BitHash hash;
  for (int id = 0; id < count; ++id) {
    const RigidBody& body = world.body(id);
    hash.add(body.place - origin);
    hash.add({body.velocity.x, body.velocity.y, body.rotation.c, body.rotation.s, body.spin});
  }
  return hash.value();
}

// Makes a heap of boxes, discs and a chain. If `has_poison`, one body has a force that cannot be computed.
std::uint64_t heapAt(const Place& origin, bool has_poison) {
  RigidWorld world;
  const auto put = [&](RigidBody body, const ConvexShape& shape) {
    const Vec2 at = body.place - Place{};
    body.place = origin + at;
    return world.add(body, shape);
  };
  put(immovable({0, 5}), boxShape(50, 5));
  const ConvexShape crate = boxShape(0.5, 0.4), disc = circleShape(0.45);
  int last = -1;
  for (int i = 0; i < 40; ++i) {
    const bool is_disc = i % 3 == 0;
    RigidBody body = movable({1.1 * (i % 7) + 0.1 * (i % 2), -1 - 1.2 * (i / 7)}, is_disc ? disc : crate);
    body.rotation = rotationBy(0.3 * i);
    const int id = put(body, is_disc ? disc : crate);
    if (i % 10 == 1) last = id;
    if (i % 10 == 2) {
      EXPECT_GE(world.addJoint(jointOf(JointKind::kHinge, last, id, {}, {0.55, 0}, {-0.55, 0})), 0);
    }
  }
  int poisoned = -1;
  if (has_poison) {
    RigidBody body = movable({0, -200}, crate);
    body.acceleration = {1e30, 0};
    poisoned = put(body, crate);
  }
  for (int tick = 0; tick < 200; ++tick) world.step();
  if (has_poison) {
    EXPECT_TRUE(world.isFrozen(poisoned));
    EXPECT_EQ(world.counters().quarantined, 1);
    EXPECT_TRUE(world.remove(poisoned));
    EXPECT_TRUE(world.set(0, world.body(0)));
  }
  return hashOf(world, origin, has_poison ? poisoned : world.idLimit());
}

TEST(RigidWorld, HashIsEqualForEveryCompilerAndFarAway) {
  const std::uint64_t here = heapAt({}, false);
  EXPECT_EQ(here, heapAt({1'000'000'000, -1'000'000'000, 0, 0}, false));
  EXPECT_EQ(here, 4075147654830738111ULL);  // the hash is equal for every compiler
}

TEST(RigidWorld, InvalidBodyAffectsNoOtherBody) {
  EXPECT_EQ(heapAt({}, false), heapAt({}, true));
  RigidWorld world;
  RigidBody body;
  body.velocity.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(world.add(body, circleShape(1)), -1);
}

TEST(RigidWorld, SleepsAtRestAndWakesWhenDisturbed) {
  RigidWorld world = onFloor({});
  const ConvexShape crate = boxShape(0.5, 0.5);
  const int lower = world.add(movable({0, -0.6}, crate), crate);
  const int upper = world.add(movable({0.1, -1.8}, crate), crate);
  for (int tick = 0; tick < 100; ++tick) world.step();
  ASSERT_TRUE(world.isAsleep(lower) && world.isAsleep(upper));
  EXPECT_EQ(world.body(lower).velocity, Vec2{});
  const RigidBody before = world.body(upper);
  const std::int64_t contacts = world.counters().contacts;
  for (int tick = 0; tick < 10; ++tick) world.step();
  EXPECT_EQ(world.body(upper), before);
  EXPECT_EQ(world.counters().contacts, contacts);  // no contact was solved

  RigidBody ball = movable({-3, -0.5}, circleShape(0.3));  // a moving body wakes the body that it hits
  ball.velocity = {0.3, 0};
  ball.friction = 0;
  const int id = world.add(ball, circleShape(0.3));
  for (int tick = 0; tick < 12; ++tick) world.step();
  EXPECT_FALSE(world.isAsleep(lower) || world.isAsleep(upper));
  world.remove(id);
  for (int tick = 0; tick < 150; ++tick) world.step();
  ASSERT_TRUE(world.isAsleep(lower) && world.isAsleep(upper));
  world.remove(0);  // a body also wakes when its support is removed
  const double height = whereIs(world, upper).y;
  for (int tick = 0; tick < 10; ++tick) world.step();
  EXPECT_NEAR(whereIs(world, upper).y - height, 0.5 * kGravityPerTick * 100, 1e-6);
}

TEST(RigidWorld, AcceleratingBodyDoesNotSleep) {
  RigidWorld world;
  const double angle = std::atan(0.5) + 0.01 * kDegree;
  const int id = addCrateOnSlope(world, angle, addSlope(world, angle));
  const double gain = kGravityPerTick * (std::sin(angle) - 0.5 * std::cos(angle));
  for (int tick = 1; tick <= 300; ++tick) {
    world.step();
    ASSERT_NEAR(length(world.body(id).velocity), gain * tick, 1e-9) << tick;
  }
}

TEST(RigidWorld, ReportsWhenContactsBeginAndEnd) {
  RigidWorld world(sleepless());
  const int wall = world.add(immovable({10, 0}), boxShape(1, 5));
  RigidBody body = floating({8, 0}, boxShape(0.5, 0.5), {0.8, 0}, 2);
  body.restitution = 0.5;
  const int id = world.add(body, boxShape(0.5, 0.5));
  world.step();
  ASSERT_EQ(world.events().size(), 1U);
  const RigidEvent begin = world.events()[0];
  EXPECT_TRUE(begin.is_begin);
  EXPECT_EQ(begin.first, wall);
  EXPECT_EQ(begin.second, id);
  EXPECT_NEAR(begin.impulse, 2 * 0.8 * 1.5, 1e-9);
  EXPECT_EQ(begin.normal, (Vec2{-1, 0}));
  EXPECT_NEAR(whereIs(world, id).x, 8.5 - 0.4 * (1 - 0.5 / 0.8), 1e-9);  // the body moves for the rest of the
                                                                         // tick after the impact
  world.step();
  ASSERT_EQ(world.events().size(), 1U);
  EXPECT_FALSE(world.events()[0].is_begin);
}

TEST(RigidWorld, ABridgeBearsItsLoad) {
  RigidWorld world(sleepless());
  const ConvexShape plank = boxShape(0.5, 0.1), crate = boxShape(0.4, 0.4);
  const int left = world.add(immovable({0, 0}), std::span<const ConvexShape>());
  const int right = world.add(immovable({19, 0}), std::span<const ConvexShape>());
  int last = left, joints = 0;
  const auto hinge = [&](int a, int b, Vec2 on_a, Vec2 on_b) {
    EXPECT_EQ(world.addJoint(jointOf(JointKind::kHinge, a, b, {}, on_a, on_b)), joints++);
  };
  Vec2 end = {0, 0};  // at the start, the chain hangs in a V
  for (int i = 0; i < 20; ++i) {
    const double rise = std::sqrt(1 - 0.95 * 0.95) * (i < 10 ? 1 : -1);
    RigidBody body = movable(end + Vec2{0.475, 0.5 * rise}, plank);
    body.rotation = {0.95, rise};
    end += Vec2{0.95, rise};
    const int id = world.add(body, plank);
    hinge(last, id, last == left ? Vec2{} : Vec2{0.5, 0}, {-0.5, 0});
    last = id;
  }
  hinge(last, right, {0.5, 0}, {});
  const int load = world.add(movable({9.5, 2.2}, crate, 10), crate);
  double worst = 0;
  for (int tick = 0; tick < 300; ++tick) {
    world.step();
    for (int i = 0; i < joints; ++i) worst = std::max(worst, gapOf(world, i));
  }
  EXPECT_LE(worst, 0.01);
  EXPECT_LT(whereIs(world, load).y, 4);  // the load lies on the bridge
}

// Impulses may not add kinetic energy if there are neither gravity nor drivers, whatever the masses, friction
// and restitution.
TEST(RigidWorld, KineticEnergyNeverGrowsWithoutDrivers) {
  SceneRandom random;
  std::int64_t restarts = 0;
  for (int scene = 0; scene < 60; ++scene) {
    RigidWorld world(sleepless());
    const int count = 3 + random.below(10);
    const double friction = random.between(0, 1), restitution = scene % 3 == 0 ? 0 : random();
    for (int i = 0; i < count; ++i) {
      const bool is_round = random() < 0.4;
      const ConvexShape shape = is_round ? circleShape(random.between(0.2, 0.5))
                                         : boxShape(random.between(0.2, 0.6), random.between(0.1, 0.5));
      const Vec2 place = {1.3 * (i % 4), 1.3 * (i / 4)};
      RigidBody body = floating(place, shape, {}, std::pow(10.0, random.between(-2, 4)));
      body.velocity = 0.2 * (Vec2{2, 2} - place) + Vec2{random.between(-0.1, 0.1), random.between(-0.1, 0.1)};
      body.rotation = rotationBy(random.between(0, 6));
      body.spin = random.between(-0.3, 0.3);
      body.friction = friction;
      body.restitution = restitution;
      world.add(body, shape);
    }
    const auto energy = [&] {
      double sum = 0;
      for (int id = 0; id < count; ++id) sum += kineticOf(world.body(id));
      return sum;
    };
    double most = energy();
    for (int tick = 0; tick < 60; ++tick) {
      world.step();
      EXPECT_LE(energy(), most * (1 + 1e-9)) << "scene " << scene << ", tick " << tick;
      most = std::min(most, energy());
    }
    restarts += world.counters().restarts;
  }
  EXPECT_GT(restarts, 0);
}

TEST(RigidWorld, StepAllocatesNothing) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  RigidWorld world = onFloor();
  const ConvexShape crate = boxShape(0.5, 0.5);
  for (int i = 0; i < 30; ++i) world.add(movable({1.01 * (i % 6), -0.5 - i / 6}, crate), crate);
  for (int tick = 0; tick < 120; ++tick) world.step();
  const std::uint64_t before = naiad::test::allocationsSoFar();
  for (int tick = 0; tick < 60; ++tick) world.step();
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
}

}  // namespace
}  // namespace naiad::physics
