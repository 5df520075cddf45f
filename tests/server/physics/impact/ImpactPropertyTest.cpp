// Properties of every ImpactWorld scene, tested on random scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "physics/impact/ImpactWorld.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/AllocationCount.h"
#include "tests/support/Sanitizers.h"

namespace naiad::physics {
namespace {

struct Scene {
  std::vector<ImpactBody> bodies;
  bool is_elastic = false;  // energy and momentum are conserved in the scene
};

double spread(SplitMix64& random, double size) {
  return size * (2 * random.unit() - 1);
}

bool isFree(const std::vector<ImpactBody>& bodies, const ImpactBody& body) {
  for (const ImpactBody& other : bodies) {
    if (touchOf(other, body, body.place - other.place).gap < 0.01) return false;
  }
  return true;
}

Scene randomScene(std::uint64_t seed) {
  SplitMix64 random(seed);
  Scene scene;
  scene.is_elastic = random.below(2) == 0;
  const bool has_walls = random.below(2) == 0;
  const double gravity = scene.is_elastic || random.below(3) == 0 ? 0 : 0.02 * random.unit();
  const double speed = std::pow(10, 1.5 * random.unit() - 1.5);
  const double friction = random.below(2) == 0 ? 0 : random.unit();
  if (has_walls) {
    for (const Vec2 out : {Vec2{0, 1}, Vec2{0, -1}, Vec2{1, 0}, Vec2{-1, 0}}) {
      ImpactBody wall;
      wall.place = placeAt(9 * out);
      wall.half = out.x == 0 ? Vec2{10, 1} : Vec2{1, 8};
      wall.inverse_mass = 0;
      wall.friction = scene.is_elastic ? 0 : friction;
      scene.bodies.push_back(wall);
    }
  }
  for (int i = 0; i < 200 && scene.bodies.size() < 30; ++i) {
    ImpactBody body;
    body.place = placeAt({spread(random, 7), spread(random, 7)});
    body.shape = random.below(2) == 0 ? ImpactShape::kCircle : ImpactShape::kBox;
    body.half = {0.1 + random.unit(), 0.1 + random.unit()};
    body.velocity = {spread(random, speed), spread(random, speed)};
    body.acceleration = {0, gravity};
    body.inverse_mass = std::pow(10, spread(random, 1));
    body.restitution = scene.is_elastic ? 1 : 0.9 * random.unit();
    body.friction = scene.is_elastic ? 0 : friction;
    if (isFree(scene.bodies, body)) scene.bodies.push_back(body);
  }
  return scene;
}

void fill(ImpactWorld& world, const Scene& scene, std::int64_t far = 0) {
  for (ImpactBody body : scene.bodies) {
    body.place.cell_x += far;
    body.place.cell_y -= far;
    ASSERT_GE(world.add(body), 0);
  }
}

double deepestOverlap(const ImpactWorld& world) {
  double deepest = 0;
  for (int i = 0; i < world.idLimit(); ++i) {
    for (int j = 0; j < i; ++j) {
      if (!world.exists(i) || !world.exists(j)) continue;
      const ImpactBody &a = world.body(j), &b = world.body(i);
      if (a.inverse_mass == 0 && b.inverse_mass == 0) continue;
      deepest = std::fmax(deepest, -touchOf(a, b, b.place - a.place).gap);
    }
  }
  return deepest;
}

struct Kept {
  Vec2 momentum;
  double energy = 0;
  double scale = 0;
};
Kept keptOf(const ImpactWorld& world) {
  Kept kept;
  for (int i = 0; i < world.idLimit(); ++i) {
    const ImpactBody& body = world.body(i);
    if (body.inverse_mass == 0) continue;
    kept.momentum += body.velocity / body.inverse_mass;
    kept.energy += 0.5 * lengthSquared(body.velocity) / body.inverse_mass;
    kept.scale += length(body.velocity) / body.inverse_mass;
  }
  return kept;
}

TEST(ImpactProperty, NothingOverlapsAndConservedQuantitiesStay) {
  std::int64_t impacts = 0, solves = 0, unconverged = 0;
  for (std::uint64_t seed = 0; seed < 1000 / test::kShare; ++seed) {
    const Scene scene = randomScene(seed);
    ImpactWorld world;
    fill(world, scene);
    const Kept before = keptOf(world);
    for (int tick = 0; tick < 20; ++tick) {
      ASSERT_EQ(world.step(), ImpactStepStatus::kDone) << seed;
      ASSERT_LE(deepestOverlap(world), 1e-9) << seed << ' ' << tick;
    }
    const Kept after = keptOf(world);
    const bool is_closed = scene.bodies[0].inverse_mass > 0 && scene.bodies[0].acceleration == Vec2{};
    if (is_closed) {
      EXPECT_LE(length(after.momentum - before.momentum), 1e-12 * before.scale) << seed;
    }
    if (scene.is_elastic) {
      EXPECT_LE(std::fabs(after.energy / before.energy - 1), 1e-12) << seed;
    }
    impacts += world.counters().impacts;
    solves += world.counters().rest_solves;
    unconverged += world.counters().unconverged;
  }
  EXPECT_GT(impacts, 50000 / test::kShare);
  EXPECT_LE(static_cast<double>(unconverged), 1e-3 * static_cast<double>(solves));
}

// Problem 16 of the laboratory (docs/physics/lab.md), compared bit for bit.
TEST(ImpactProperty, DistantScenesGiveTheSameBits) {
  for (std::uint64_t seed = 0; seed < 200 / test::kShare; ++seed) {
    const Scene scene = randomScene(seed);
    ImpactWorld here;
    fill(here, scene);
    for (int tick = 0; tick < 20; ++tick) here.step();
    for (const std::int64_t far : {1'000'000LL, 1'000'000'000LL, -1'000'000'000'000LL}) {
      ImpactWorld there;
      fill(there, scene, far);
      for (int tick = 0; tick < 20; ++tick) there.step();
      for (int i = 0; i < here.idLimit(); ++i) {
        ImpactBody moved = there.body(i);
        moved.place.cell_x -= far;
        moved.place.cell_y += far;
        ASSERT_EQ(moved, here.body(i)) << seed << ' ' << far << ' ' << i;
      }
    }
  }
}

// A distant scene has no effect on this one, whether its bodies are added first or last, and frozen or not.
TEST(ImpactProperty, SeparateSceneChangesNothing) {
  for (std::uint64_t seed = 0; seed < 200 / test::kShare; ++seed) {
    const Scene scene = randomScene(seed), other = randomScene(seed + 5000);
    ImpactWorld alone, first, last;
    fill(alone, scene);
    fill(first, other, 100000);
    ImpactBody wild;
    wild.velocity = {1e29, 0};  // crosses every scene in its first tick, unless it is frozen
    wild.place = placeAt({-1e6, 0});
    first.add(wild);
    const int offset = first.idLimit();
    fill(first, scene);
    fill(last, scene);
    fill(last, other, 100000);
    for (int tick = 0; tick < 20; ++tick) {
      alone.step();
      EXPECT_EQ(first.step(), tick == 0 ? ImpactStepStatus::kQuarantined : ImpactStepStatus::kDone);
      last.step();
    }
    for (int i = 0; i < alone.idLimit(); ++i) {
      ASSERT_EQ(alone.body(i), first.body(offset + i)) << seed << ' ' << i;
      ASSERT_EQ(alone.body(i), last.body(i)) << seed << ' ' << i;
    }
    EXPECT_TRUE(first.isFrozen(offset - 1));
    EXPECT_EQ(first.counters().quarantined, 1);
  }
}

// In one of these scenes, bounces too low for a double were repeated without end.
TEST(ImpactProperty, ScenesThatOnceFailedNowWork) {
  for (const std::uint64_t seed : {98U, 371U, 377U, 758U, 9444U}) {
    ImpactWorld world;
    fill(world, randomScene(seed));
    for (int tick = 0; tick < 40; ++tick) {
      ASSERT_EQ(world.step(), ImpactStepStatus::kDone) << seed;
      ASSERT_LE(deepestOverlap(world), 1e-9) << seed;
    }
  }
}

// Problem 14. Shoots at all kinds of bodies at all speeds, and checks on which side each projectile ends.
TEST(ImpactProperty, FastBodiesDoNotTunnel) {
  SplitMix64 random(14);
  int shots = 0;
  for (int i = 0; i < 20000 / test::kShare; ++i) {
    const double speed = std::pow(10, 1 + 3.5 * random.unit()) / 30 * 10;  // up to 1e6 cells per second
    ImpactBody bullet, target;
    for (ImpactBody* body : {&bullet, &target}) {
      body->shape = random.below(2) == 0 ? ImpactShape::kCircle : ImpactShape::kBox;
      body->half = {0.01 + 0.5 * random.unit(), 0.01 + 0.5 * random.unit()};
      body->restitution = random.below(2) == 0 ? 0.0 : random.unit();
    }
    const double angle = spread(random, 3), c = std::cos(angle), s = std::sin(angle);
    const Vec2 direction = {c, s};
    const double meeting = random.unit();  // time within the tick
    const Vec2 middle = {spread(random, 100), spread(random, 100)};
    const auto kind = random.below(4);  // static, kinematic, dynamic, or as fast as the bullet
    if (kind == 1 || kind == 3) target.velocity = {spread(random, speed), spread(random, speed)};
    if (kind < 2) target.inverse_mass = 0;
    bullet.velocity = speed * direction;
    const Vec2 relative = bullet.velocity - target.velocity;
    const double away = length(relative);
    if (away < 10) continue;
    // Without a contact, they would overlap almost centrally at the time `meeting`. They start clearly apart.
    const Vec2 off = 0.5 * std::fmin(std::fmin(bullet.half.x, bullet.half.y), target.half.x) *
                     Vec2{spread(random, 0.5), spread(random, 0.5)};
    bullet.place = placeAt(middle + off - meeting * bullet.velocity);
    target.place = placeAt(middle - meeting * target.velocity);
    if (meeting * away < 4) continue;
    ImpactWorld world;
    const bool is_first = random.below(2) == 0;
    const int a = world.add(is_first ? bullet : target);
    world.add(is_first ? target : bullet);
    world.step();
    ++shots;
    const Vec2 displacement = world.body(1 - a).place - world.body(a).place;
    const Vec2 gone = world.body(1 - a).velocity - world.body(a).velocity;
    const ImpactTouch touch = touchOf(world.body(a), world.body(1 - a), displacement);
    ASSERT_EQ(world.counters().impacts > 0, true) << i;
    ASSERT_GE(touch.gap, -1e-9) << i;
    ASSERT_GE(dot(gone, touch.normal), -1e-6 * speed) << i;
  }
  EXPECT_GT(shots, 10000 / test::kShare);
}

TEST(ImpactProperty, InvalidNumbersAreRefused) {
  ImpactWorld world;
  const ImpactBody good;
  const int id = world.add(good);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  for (const double bad : {nan, inf, -inf, 2e30}) {
    std::vector<ImpactBody> bodies(5, good);
    bodies[0].velocity.x = bad;
    bodies[1].acceleration.y = bad;
    bodies[2].half.x = bad;
    bodies[3].inverse_mass = bad;
    bodies[4].place.dx = bad;
    EXPECT_EQ(world.add(bodies[0]), -1);
    for (const ImpactBody& body : bodies) EXPECT_FALSE(world.set(id, body));
    EXPECT_EQ(world.step(bad), ImpactStepStatus::kRefused);
  }
  ImpactBody point;
  point.half = {0, 0};
  EXPECT_EQ(world.add(point), -1);
  EXPECT_EQ(world.body(id), good);
  EXPECT_EQ(world.step(0), ImpactStepStatus::kRefused);
  EXPECT_EQ(world.step(5e-324), ImpactStepStatus::kDone);
  EXPECT_EQ(world.step(1e6), ImpactStepStatus::kDone);
}

// If a crowd has more pairs than a tick's work allows, they are neither examined nor all counted. Other pairs
// are.
TEST(ImpactProperty, OversizedCrowdIsAbandonedBeforeTestingItsPairs) {
  constexpr int kCrowd = 2000;
  SplitMix64 random(4);
  ImpactWorld world;
  world.setReserve(1e7);
  for (int i = 0; i < kCrowd; ++i) {
    ImpactBody body;
    body.shape = ImpactShape::kCircle;
    body.place = placeAt({random.unit(), random.unit()});
    body.velocity = {0.1 * random.unit(), 0.1 * random.unit()};
    world.add(body);
  }
  ImpactBody ball;
  ball.shape = ImpactShape::kCircle;
  ball.restitution = 1;
  ball.place = placeAt({1000, 0});
  ball.velocity = {3, 0};
  const int moving = world.add(ball);
  ball.place = placeAt({1002, 0});
  ball.velocity = {};
  const int struck = world.add(ball);
  world.step();
  const double share = ImpactWorld::kWorkOfBody * kCrowd + ImpactWorld::kWorkOfTick + 1e7;
  EXPECT_LE(static_cast<double>(world.counters().forecasts), share / 80);
  EXPECT_GT(world.counters().given_up, kCrowd / 2);
  EXPECT_FALSE(world.isGivenUp(moving));
  EXPECT_NEAR(world.body(moving).velocity.x, 0, 1e-12);
  EXPECT_NEAR(world.body(struck).velocity.x, 3, 1e-12);
}

// Free ids are reused; the lowest one first.
TEST(ImpactProperty, LowestFreeIdIsReused) {
  ImpactWorld world;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(world.add({}), i);
  world.remove(3);
  world.remove(1);
  EXPECT_EQ(world.add({}), 1);
  EXPECT_EQ(world.add({}), 3);
  EXPECT_EQ(world.add({}), 5);
}

TEST(ImpactProperty, AllocatesNothingOnceWarm) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  ImpactWorld world;
  SplitMix64 random(3);
  Scene scene = randomScene(6);
  for (ImpactBody& body : scene.bodies) body.restitution = 1;
  fill(world, scene);
  for (int tick = 0; tick < 300; ++tick) world.step();
  const auto before = naiad::test::allocationsSoFar();
  const auto impacts = world.counters().impacts;
  for (int tick = 0; tick < 100; ++tick) world.step();
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
  EXPECT_GT(world.counters().impacts, impacts);
}

}  // namespace
}  // namespace naiad::physics
