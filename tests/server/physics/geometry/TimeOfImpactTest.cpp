#include "physics/geometry/ShapeDistance.h"
#include "physics/geometry/TimeOfImpact.h"
#include "tests/server/physics/RandomShapes.h"
#include "tests/support/Sanitizers.h"

namespace naiad::physics {
namespace {

using naiad::test::kShare;
using namespace test;

struct Scene {
  ConvexShape a, b;
  RigidMotion motion_a, motion_b;
  Vec2 offset;
};

// Returns the gap at time t by the slow method and the standard library's sine.
double gapAt(const Scene& s, double t) {
  const auto rotation = [&](const RigidMotion& m) {
    return m.start * Rotation{std::cos(m.turn * t), std::sin(m.turn * t)};
  };
  return test::slowGap(s.a, rotation(s.motion_a), s.b, rotation(s.motion_b),
                       s.offset + t * (s.motion_b.displacement - s.motion_a.displacement));
}

// Makes a random scene. In about half of the scenes the shapes hit, because the paths cross near A's origin.
Scene anyScene(SplitMix64& random, double speed, double spin) {
  Scene s = {anyShape(random), anyShape(random), {}, {}, {}};
  s.motion_a = {anyVec(random, speed), anyRotation(random), between(random, -spin, spin)};
  s.motion_b = {anyVec(random, speed), anyRotation(random), between(random, -spin, spin)};
  const Vec2 displacement = s.motion_b.displacement - s.motion_a.displacement;
  s.offset = anyVec(random, 3) - between(random, -0.3, 1.3) * displacement;
  return s;
}

struct Tally {
  int hits = 0, apart = 0, unresolved = 0;
};

// Compares the result for a scene with the gaps at `samples` times by the slow method.
void judge(const Scene& s, int samples, Tally& tally, int i) {
  const TimeOfImpact result = timeOfImpact(s.a, s.motion_a, s.b, s.motion_b, s.offset);
  const Vec2 displacement = s.motion_b.displacement - s.motion_a.displacement;
  const double tolerance = 4 * impactTolerance(s.a, s.b, s.offset, displacement) + 1e-12;
  if (result.touched_before) {
    ASSERT_LE(gapAt(s, 0), tolerance) << i;
    return;
  }
  if (result.status == TimeOfImpactStatus::kUnresolved) {
    ++tally.unresolved;
  } else if (result.status == TimeOfImpactStatus::kHit) {
    ++tally.hits;
    // At the time of the result, the shapes touch.
    ASSERT_LE(gapAt(s, result.time), tolerance) << i;
    ASSERT_NEAR(length(result.normal), 1, 1e-14);
  } else {
    ++tally.apart;
    ASSERT_EQ(result.time, 1);
  }
  // Before that time, they do not touch. They can touch only while the circles around the origins overlap, so
  // only that time is sampled.
  const double reach = s.a.reach + s.b.reach + s.a.radius + s.b.radius, speed = length(displacement);
  const double middle = speed > 0 ? -dot(s.offset, displacement) / (speed * speed) : 0.5;
  const double half = speed > 0 ? reach / speed : 1;
  const double from = std::clamp(middle - half, 0.0, 1.0), to = std::clamp(middle + half, 0.0, 1.0);
  for (int k = 0; k <= samples; ++k) {
    const double t = from + (to - from) * k / samples;
    if (t >= result.time * (1 - 1e-12)) break;
    ASSERT_GT(gapAt(s, t), -tolerance) << i << " at " << t << " of " << result.time;
  }
}

void run(const char* name, std::uint64_t seed, int count, double speed, double spin, int samples) {
  SCOPED_TRACE(name);
  SplitMix64 random(seed);
  Tally tally;
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
    judge(anyScene(random, speed, spin), samples, tally, i);
  }
  EXPECT_EQ(tally.unresolved, 0);
  EXPECT_GT(tally.hits, count / 20);
  EXPECT_GT(tally.apart, count / 20);
}

TEST(TimeOfImpact, NeverMissesNorInventsAHit) {
  run("slow", 1, 20000 / kShare, 2, 0.5, 60);
  run("1000 cells", 2, 20000 / kShare, 1e3, 3, 60);
  run("1e6 cells", 3, 20000 / kShare, 1e6, 6, 60);
  run("straight", 4, 20000 / kShare, 10, 0, 60);
  run("spinning", 5, 20000 / kShare, 1, 30, 200);
}

TEST(TimeOfImpact, TouchingPairHitsOnlyWhenApproaching) {
  const ConvexShape a = test::boxShape(0.5, 0.5), b = test::boxShape(0.5, 0.5);
  for (const Vec2 displacement : {Vec2{0, -1}, {5, 0}, {-1e6, 0}, {3, -1e-9}, {0, 0}, {1e6, -1e6}}) {
    const TimeOfImpact result = timeOfImpact(a, {}, b, {displacement, {}, 0}, {0, -1});
    EXPECT_TRUE(result.touched_before);
    EXPECT_EQ(result.status, TimeOfImpactStatus::kApart) << displacement.x << ", " << displacement.y;
  }
  for (const Vec2 displacement : {Vec2{0, 1}, {0.4, 1e-3}, {0, 1e6}}) {
    const TimeOfImpact result = timeOfImpact(a, {}, b, {displacement, {}, 0}, {0, -1});
    EXPECT_TRUE(result.touched_before);
    ASSERT_EQ(result.status, TimeOfImpactStatus::kHit);
    EXPECT_LE(result.time * length(displacement), 1e-5);
    EXPECT_NEAR(result.normal.y, -1, 1e-12);
  }
  // The shapes overlap: once they separate, once they move into each other.
  EXPECT_EQ(timeOfImpact(a, {}, b, {{0, -3}, {}, 0}, {0, -0.9}).status, TimeOfImpactStatus::kApart);
  EXPECT_EQ(timeOfImpact(a, {}, b, {{0, 0.3}, {}, 0}, {0, -0.9}).status, TimeOfImpactStatus::kHit);
}

// Pairs that touch at the start hit only if they approach.
TEST(TimeOfImpact, TouchingPairsNeverPenetrateBeforeTheHit) {
  SplitMix64 random(7);
  int hits = 0, late = 0, apart = 0;
  for (int i = 0; i < 20000 / kShare; ++i) {
    Scene s = anyScene(random, 1, 3);
    const RotatedShape a = rotated(s.a, s.motion_a.start), b = rotated(s.b, s.motion_b.start);
    s.offset = anyVec(random, 3);
    const Separation first = separation(a, b, s.offset);
    s.offset -= (first.distance - (s.a.radius + s.b.radius)) * first.normal;
    // If the shapes overlap or are distant, a movement along the normal may not make them touch.
    if (std::fabs(gapAt(s, 0)) > 1e-12) continue;
    const TimeOfImpact result = timeOfImpact(s.a, s.motion_a, s.b, s.motion_b, s.offset);
    ASSERT_TRUE(result.touched_before);
    ASSERT_NE(result.status, TimeOfImpactStatus::kUnresolved) << i;
    // The slow method gives no depth for overlapping cores: it returns minus the sum of the radii.
    const double tolerance = 8 * impactTolerance(s.a, s.b, s.offset, s.motion_b.displacement) + 1e-12;
    for (int k = 0; k <= 400; ++k) {
      const double t = k / 400.0;
      if (result.status == TimeOfImpactStatus::kHit && t >= result.time) break;
      ASSERT_GT(gapAt(s, t), -tolerance) << i << " at " << t;
    }
    result.status == TimeOfImpactStatus::kHit ? ++(result.time > 1e-3 ? late : hits) : ++apart;
  }
  EXPECT_GT(hits, 1000 / kShare);
  EXPECT_GT(late, 500 / kShare);
  EXPECT_GT(apart, 1000 / kShare);
}

TEST(TimeOfImpact, StopsAtTheTargetDistance) {
  const ConvexShape a = test::boxShape(0.5, 0.5), b = test::boxShape(0.5, 0.5);
  const TimeOfImpact result = timeOfImpact(a, {}, b, {{0, 10}, {}, 0}, {0.3, -6}, 0.25);
  ASSERT_EQ(result.status, TimeOfImpactStatus::kHit);
  EXPECT_NEAR(result.time, 0.475, 1e-12);
  EXPECT_NEAR(result.gap, 0.25, 1e-9);
}

TEST(TimeOfImpact, SwappedShapesGiveTheSameTime) {
  SplitMix64 random(8);
  for (int i = 0; i < 20000; ++i) {
    const Scene s = anyScene(random, 10, 2);
    const TimeOfImpact there = timeOfImpact(s.a, s.motion_a, s.b, s.motion_b, s.offset);
    const TimeOfImpact back = timeOfImpact(s.b, s.motion_b, s.a, s.motion_a, -s.offset);
    ASSERT_EQ(there.status, back.status);
    ASSERT_NEAR(there.time, back.time, 1e-9) << i;
  }
}

TEST(TimeOfImpact, BulletHitsAThinWallAtAnySpeed) {
  SplitMix64 random(9);
  const ConvexShape bullet = test::boxShape(0.05, 0.05), wall = test::boxShape(0.001, 10);
  for (int i = 0; i < 100000; ++i) {
    const double speed = std::pow(10, between(random, 0, 6)), at = between(random, 0.01, 0.99);
    const RigidMotion motion = {{speed, between(random, -5, 5)}, anyRotation(random), between(random, -6, 6)};
    const TimeOfImpact result = timeOfImpact(wall, {}, bullet, motion, {-speed * at, 0});
    ASSERT_NE(result.status, TimeOfImpactStatus::kApart) << i;
    if (!result.touched_before) {
      ASSERT_EQ(result.status, TimeOfImpactStatus::kHit) << i;
      ASSERT_LT(result.time, at);
      ASSERT_GT(result.time, at - 0.1 / speed);
    }
  }
}

}  // namespace
}  // namespace naiad::physics
