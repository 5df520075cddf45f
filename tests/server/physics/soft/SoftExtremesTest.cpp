#include "SoftScene.h"
#include "tests/server/physics/BitHash.h"
#include "tests/support/AllocationCount.h"
#include "tests/support/NotANumber.h"

namespace naiad::physics {
namespace {

using test::kBody;
using test::kGravity;

// A scene with all kinds of soft bodies, `east` cells from the origin.
class Scene {
 public:
  explicit Scene(std::int64_t east = 0)
      : m_east(east), m_slab(test::boxShape(20, 1)), m_cube(test::boxShape(0.5, 0.5)) {
    world.setGravity({0, kGravity});
    SoftBody blob = makeBlob(place({0, -2.2}), 2, 16, 10, 0.05, 0.2, 0.5, 0.01);
    blob.friction = 0.5;
    world.add(blob);
    blob.place = place({0.4, -7});
    world.add(blob);
    SoftBody rope = makeRope(place({6, -9}), {4, 0}, 8, 2, 100, 0.01);
    rope.nodes[0].is_pinned = true;
    world.add(rope);
    world.attach({2, 8, 1, {-0.5, 0}});
    world.add(makeBeam(place({-12, -5}), {6, 0}, 8, 20, 1e4, 1, true));
    world.add(makeCloth(place({-10, -9}), {4, 0}, {0, 1}, 6, 2, 2, 10, 5, 0.01));
    obstacles[0] = test::obstacleAt(0, m_slab, {0, 1}, 0.5);
    obstacles[1] = test::crateAt(1, m_cube, {10.5, -9}, 2, 6);
    for (SoftObstacle& o : obstacles) o.place.cell_x += east;
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void step(double dt = 1) {
    world.step(dt, obstacles);
    for (SoftObstacle& o : obstacles) {
      if (o.inverse_mass > 0) test::advance(o, dt);
    }
  }
  Place place(Vec2 at) const {
    Place there = placeAt(at);
    there.cell_x += m_east;
    return there;
  }
  std::uint64_t hash(int bodies = 5) const {
    test::BitHash hash;
    for (int id = 0; id < bodies; ++id) {
      hash.add(world.body(id).place - place({}));
      for (const SoftNode& node : world.body(id).nodes) hash.add(node.offset), hash.add(node.velocity);
    }
    hash.add(obstacles[1].place - place({}));
    hash.add(obstacles[1].spin);
    return hash.value();
  }

  SoftWorld world;
  SoftObstacle obstacles[2];

 private:
  std::int64_t m_east;
  ConvexShape m_slab, m_cube;
};

// The hash is equal for every compiler and optimisation level.
TEST(SoftWorld, HashIsTheSameOnEveryPlatform) {
  Scene scene;
  for (int i = 0; i < 200; ++i) scene.step();
  EXPECT_EQ(scene.hash(), 17057286927604812260U);
}

// Problem 16 of docs/physics/lab.md.
TEST(SoftWorld, MovesTheSameFarAway) {
  Scene here, there(1'000'000'000);
  for (int i = 0; i < 200; ++i) {
    here.step();
    there.step();
    ASSERT_EQ(here.hash(), there.hash()) << i;
  }
}

// The place follows a body that falls by x + vt + gt²/2, except for the Euler method of the first sub-step.
TEST(SoftWorld, FollowsABodyThatFallsFar) {
  SoftWorld world;
  world.setGravity({0, kGravity});
  SoftBody rope = makeRope({}, {4, 0}, 8, 1, 100, 0.01);
  for (SoftNode& node : rope.nodes) node.velocity = {3, -2};
  const int id = world.add(rope);
  constexpr int kLong = 2000;
  for (int i = 0; i < kLong; ++i) world.step();
  // An error of d at the start becomes 3/2 d and stays so.
  const double first = 1.5 * 0.5 * kGravity / SoftWorld::kDefaultSubsteps / SoftWorld::kDefaultSubsteps;
  for (int i = 0; i <= 8; ++i) {
    EXPECT_NEAR(test::nodeAt(world, id, i).x, 3.0 * kLong + 0.5 * i, 1e-8);
    EXPECT_NEAR(test::nodeAt(world, id, i).y, -2.0 * kLong + 0.5 * kGravity * kLong * kLong + first, 1e-6);
    EXPECT_LT(length(world.body(id).nodes[static_cast<std::size_t>(i)].offset), 1100);
  }
  EXPECT_EQ(world.counters().limited, 0);
}

TEST(SoftWorld, AllocatesNothingOnceWarm) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  Scene scene;
  for (int i = 0; i < 400; ++i) scene.step();
  const auto before = naiad::test::allocationsSoFar();
  for (int i = 0; i < 100; ++i) scene.step();
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
}

// Problem 18: functions refuse invalid numbers.
TEST(SoftWorld, InvalidBodiesAndNumbersAreRefused) {
  SoftWorld world;
  const SoftBody rope = makeRope({}, {4, 0}, 4, 1, 10);
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e30}) {
    SoftBody displaced = rope, weighed = rope, stiffened = rope;
    displaced.nodes[2].offset.x = weighed.nodes[2].mass = stiffened.stretches[1].stiffness = bad;
    for (const SoftBody& body : {displaced, weighed, stiffened}) EXPECT_EQ(world.add(body), -1);
    EXPECT_EQ(world.add(makeRope({}, {bad, 0}, 4, 1, 10)), -1);
    EXPECT_EQ(world.add(makeBlob({}, bad, 8, 1, 0, 1, 1)), -1);
    EXPECT_FALSE(world.setGravity({bad, 0}));
    EXPECT_EQ(world.step(bad), SoftStatus::kRefused);
  }
  SoftBody none = rope;
  none.nodes[1].mass = 0;
  EXPECT_EQ(world.add(none), -1);
  none = rope;
  none.stretches[0].b = 9;
  EXPECT_EQ(world.add(none), -1);
  EXPECT_EQ(world.add({}), -1);
  EXPECT_EQ(world.add(makeRope({}, {0, 0}, 4, 1, 10)), -1);
  EXPECT_EQ(world.add(makeRope({}, {1, 0}, 0, 1, 10)), -1);
  const int id = world.add(rope);
  EXPECT_EQ(id, 0);
  EXPECT_FALSE(world.setForce(id, 0, {kNan, 0}));
  EXPECT_FALSE(world.applyImpulse(id, 9, {1, 0}));
  SoftObstacle obstacle;
  obstacle.velocity.x = kNan;
  EXPECT_EQ(world.step(1, {&obstacle, 1}), SoftStatus::kRefused);
}

// Problem 18: a body that cannot be computed is frozen. All other bodies move as in a world without it.
TEST(SoftWorld, UnsolvableBodyFreezesAlone) {
  Scene without, with;
  SoftBody doomed = makeRope(placeAt({0, -30}), {4, 0}, 8, 1, 1e10);
  for (SoftNode& node : doomed.nodes) node.mass = 1e-12;
  const int id = with.world.add(doomed);
  for (int i = 0; i < 100; ++i) {
    if (i == 20) {
      ASSERT_TRUE(with.world.setForce(id, 3, {1e12, -1e12}));
    }
    without.step();
    with.step();
    ASSERT_EQ(without.hash(), with.hash()) << i;
  }
  EXPECT_TRUE(with.world.isFrozen(id));
  EXPECT_EQ(with.world.counters().quarantined, 1);
  for (const SoftNode& node : with.world.body(id).nodes) {
    EXPECT_TRUE(isFinite(node.offset) && isFinite(node.velocity));
  }
  ASSERT_TRUE(with.world.set(id, makeRope(placeAt({0, -30}), {4, 0}, 8, 1, 1)));
  EXPECT_FALSE(with.world.isFrozen(id));
}

// Sudden long steps, and hundreds of bodies in one place: results stay bounded, and failures are counted.
TEST(SoftWorld, StaysBoundedInExtremes) {
  Scene scene;
  for (const double dt : {1.0, 1e3, 1e-6, 10.0, 1e-3, 100.0, 1.0}) scene.step(dt);
  SoftWorld crowd;
  crowd.setSubsteps(1);
  constexpr int kMany = 300;
  for (int i = 0; i < kMany; ++i) crowd.add(makeBlob(placeAt({0.001 * i, 0}), 1, 8, 1, 0.05, 0.2, 0.5));
  for (int i = 0; i < 10; ++i) crowd.step();
  EXPECT_GE(crowd.counters().crowded, 10 * (kMany - SoftCrowd::kMaxOthers));
  for (int id = 0; id < 5; ++id) EXPECT_TRUE(isFinite(test::momentumOf(scene.world.body(id))));
  for (int id = 0; id < kMany; ++id) {
    EXPECT_LT(length(test::centreOf(crowd, id)), 200);
    EXPECT_LT(test::fastest(crowd.body(id)), 10);
  }
}

// Mass ratios from 1 to 1e6, with the light body on the heavy one and vice versa.
TEST(SoftWorld, BearsMassRatiosToAMillion) {
  const ConvexShape cube = test::boxShape(1, 1), slab = test::boxShape(20, 1);
  for (const double mass : {1e-3, 1e3, 1e6}) {
    SoftObstacle all[] = {test::obstacleAt(0, slab, {0, 1}, 0.5), test::crateAt(1, cube, {0, -6}, mass, 1.5)};
    SoftBody blob = makeBlob(placeAt({0, -2.2}), 2, 16, 1, 0.05, 0.2, 0.5, 0.01);
    blob.drag = 0.02;
    SoftWorld world = test::worldWith(blob, kGravity);
    for (int i = 0; i < 600; ++i) {
      world.step(1, all);
      test::advance(all[1]);
      // No kinetic energy is larger than that of the crate after its whole fall.
      double kinetic = 0;
      for (const SoftNode& node : world.body(kBody).nodes)
        kinetic += 0.5 * node.mass * lengthSquared(node.velocity);
      ASSERT_LT(kinetic, kGravity * (10 * mass + 1000)) << mass << ' ' << i;
      ASSERT_LT(length(all[1].velocity), kGravity * 610) << mass << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace naiad::physics
