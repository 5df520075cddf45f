#include "physics/broadphase/BroadPhase.h"
#include "physics/geometry/Manifold.h"
#include "physics/geometry/Mass.h"
#include "physics/geometry/ShapeDistance.h"
#include "physics/geometry/ShapeQuery.h"
#include "physics/geometry/TimeOfImpact.h"
#include "tests/server/physics/BitHash.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

using namespace test;

double smallest(const Manifold& m) {
  return m.count == 2 ? std::min(m.points[0].separation, m.points[1].separation) : m.points[0].separation;
}

TEST(ShapeDistance, MatchesBruteForceCornerEdgeDistances) {
  SplitMix64 random(1);
  int apart = 0, overlapping = 0, seen_by_faces = 0;
  for (int i = 0; i < 100000; ++i) {
    const ConvexShape a = anyShape(random), b = anyShape(random);
    const Rotation qa = anyRotation(random), qb = anyRotation(random);
    const Vec2 offset = anyVec(random, 3);
    const RotatedShape ta = rotated(a, qa), tb = rotated(b, qb);
    const double truth = test::slowDistance(test::placed(a, qa, {}), test::placed(b, qb, offset));
    const Separation s = separation(ta, tb, offset);
    EXPECT_NEAR(length(s.normal), 1, 1e-15);
    if (truth > 0) {
      ++apart;
      ASSERT_NEAR(s.distance, truth, 1e-13) << i;
      const double least = faceGap(ta, offset, tb.reach + tb.radius);
      ASSERT_LE(least, truth - ta.radius - tb.radius + 1e-13) << i;
      seen_by_faces += least > 0 ? 1 : 0;
    } else {
      ++overlapping;
      ASSERT_LE(s.distance, 1e-13) << i;
      // After a movement by the overlap along the normal, the shapes only touch.
      const Vec2 out = offset + (1e-9 - s.distance) * s.normal;
      ASSERT_NEAR(test::slowDistance(test::placed(a, qa, {}), test::placed(b, qb, out)), 1e-9, 1e-12) << i;
    }
  }
  EXPECT_GT(apart, 30000);
  EXPECT_GT(seen_by_faces, 10000);
  EXPECT_GT(overlapping, 5000);
}

TEST(ShapeDistance, IsExactForParallelEdgesAndCollinearPoints) {
  SplitMix64 random(2);
  for (int i = 0; i < 100000; ++i) {
    // Multiples of 1/4 with equal rotations make many equal distances, of which rounding chooses one.
    const auto coarse = [&](double most) { return std::round(between(random, -4 * most, 4 * most)) / 4; };
    ConvexShape shapes[2];
    for (ConvexShape& shape : shapes) {
      ShapeStatus status = ShapeStatus::kTooFew;
      while (status != ShapeStatus::kOk) {
        const Vec2 centre = {coarse(1), coarse(1)};
        status = random.unit() < 0.5
                     ? makeBox(std::fabs(coarse(1)), std::fabs(coarse(1)), centre, {}, 0, shape)
                     : makeCapsule(centre, centre + Vec2{coarse(2), 0}, 0.25, shape);
      }
    }
    const Rotation q = random.unit() < 0.3 ? Rotation{} : anyRotation(random);
    const Vec2 displacement = q * Vec2{coarse(3), coarse(3)};
    const double truth =
        test::slowDistance(test::placed(shapes[0], q, {}), test::placed(shapes[1], q, displacement));
    const Separation s = separation(rotated(shapes[0], q), rotated(shapes[1], q), displacement);
    if (truth > 1e-12) {
      ASSERT_NEAR(s.distance, truth, 1e-13) << i;
    } else {
      ASSERT_LE(s.distance, 1e-12) << i;
    }
  }
}

TEST(ShapeDistance, LongCapsulesThatCrossOverlap) {
  SplitMix64 random(8);
  int crossed = 0;
  for (int i = 0; i < 20000; ++i) {
    ConvexShape a, b;
    ASSERT_EQ(makeCapsule({-3, 0}, {between(random, 0.1, 3), 0}, 0.1, a), ShapeStatus::kOk);
    ASSERT_EQ(makeCapsule({-3, 0}, {between(random, 0.1, 3), 0}, 0.1, b), ShapeStatus::kOk);
    const Rotation qa = anyRotation(random), qb = turned(qa, between(random, -0.3, 0.3));
    const Vec2 offset = anyVec(random, 1);
    const RotatedShape ta = rotated(a, qa), tb = rotated(b, qb);
    const Separation s = separation(ta, tb, offset);
    if (test::slowDistance(test::placed(a, qa, {}), test::placed(b, qb, offset)) > 0) continue;
    ++crossed;
    ASSERT_LE(s.distance, 0) << i;
    const Vec2 out = offset + (1e-9 - s.distance) * s.normal;
    ASSERT_NEAR(test::slowDistance(test::placed(a, qa, {}), test::placed(b, qb, out)), 1e-9, 1e-12) << i;
  }
  EXPECT_GT(crossed, 1000);
}

TEST(Manifold, AxisAlignedBoxesAreExact) {
  const ConvexShape big = boxShape(0.5, 0.5), plank = boxShape(3, 0.3);
  for (const double gap : {0.0, 0x1p-20, -0x1p-20, 0x1p-45, -0x1p-8}) {
    for (const Rotation q : {Rotation{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      for (const double side : {0.0, 0.25, -0.75}) {
        Manifold m;
        const Vec2 offset = q * Vec2{side, -1 - gap};
        ASSERT_TRUE(collide(big, q, big, q, offset, 0.1, m));
        EXPECT_EQ(m.count, 2);
        EXPECT_EQ(m.normal, (q * Vec2{0, -1}));
        for (const ManifoldPoint& point : m.points) {
          EXPECT_EQ(point.separation, gap);
          EXPECT_EQ(point.anchor_a - point.anchor_b, offset);
          const Vec2 at = inverse(q) * point.anchor_a;
          EXPECT_EQ(at.y, -0.5 - gap / 2);
          EXPECT_TRUE(at.x == std::max(-0.5, side - 0.5) || at.x == std::min(0.5, side + 0.5));
        }
        EXPECT_NE(m.points[0].anchor_a, m.points[1].anchor_a);
      }
    }
  }
  // The sizes are not binary fractions: 0.3 + 0.5 is rounded, but at this distance the gap must be zero.
  Manifold m;
  ASSERT_TRUE(collide(plank, {}, big, {}, {1, -(0.3 + 0.5)}, 0, m));
  EXPECT_EQ(m.points[0].separation, 0);
  EXPECT_EQ(m.points[1].separation, 0);
}

TEST(Manifold, SmallestSeparationEqualsTheGap) {
  SplitMix64 random(3);
  int with_two = 0, with_one = 0;
  for (int i = 0; i < 100000; ++i) {
    const ConvexShape a = anyShape(random), b = anyShape(random);
    const Rotation qa = anyRotation(random), qb = anyRotation(random);
    const Vec2 offset = anyVec(random, 3);
    const double gap = test::slowGap(a, qa, b, qb, offset), speculative = between(random, 0, 0.5);
    Manifold m;
    const bool found = collide(a, qa, b, qb, offset, speculative, m);
    if (gap > speculative + 1e-12) {
      ASSERT_FALSE(found) << i;
    }
    if (gap < speculative - 1e-12) {
      ASSERT_TRUE(found) << i;
    }
    if (!found) continue;
    (m.count == 2 ? with_two : with_one)++;
    if (gap > 1e-12 - (a.radius + b.radius)) {
      ASSERT_NEAR(smallest(m), gap, 1e-12) << i;
    }
    for (int k = 0; k < m.count; ++k) {
      const ManifoldPoint& point = m.points[static_cast<std::size_t>(k)];
      EXPECT_LE(point.separation, speculative);
      EXPECT_LE(length(point.anchor_a - point.anchor_b - offset), 1e-14);
      // Each shape contains the point that is half the gap away on the shape's side.
      const Vec2 on_a = point.anchor_a - 0.5 * point.separation * m.normal;
      const Vec2 on_b = point.anchor_b + 0.5 * point.separation * m.normal;
      EXPECT_LE(test::slowDistance(test::placed(a, qa, {}), {on_a}), a.radius + 1e-10) << i;
      EXPECT_LE(test::slowDistance(test::placed(b, qb, {}), {on_b}), b.radius + 1e-10) << i;
    }
  }
  EXPECT_GT(with_two, 3000);
  EXPECT_GT(with_one, 3000);
}

TEST(Manifold, SwappedShapesGiveTheMirroredManifold) {
  SplitMix64 random(4);
  for (int i = 0; i < 100000; ++i) {
    const ConvexShape a = anyShape(random), b = anyShape(random);
    const Rotation qa = anyRotation(random), qb = anyRotation(random);
    const Vec2 offset = anyVec(random, 2);
    Manifold there, back;
    ASSERT_EQ(collide(a, qa, b, qb, offset, 0.2, there), collide(b, qb, a, qa, -offset, 0.2, back));
    if (there.count == 0) continue;
    ASSERT_EQ(there.normal, -back.normal) << i;
    ASSERT_EQ(there.count, back.count);
    ASSERT_EQ(smallest(there), smallest(back));
    for (const auto k : {0U, 1U}) {
      if (k >= static_cast<unsigned>(there.count)) break;
      const std::uint32_t id = there.points[k].id, swapped = (id & 255) << 8 | id >> 8;
      const auto& same = back.count == 2 && back.points[1].id == swapped ? back.points[1] : back.points[0];
      EXPECT_EQ(same.id, swapped) << i;
      EXPECT_LE(length(same.anchor_b - there.points[k].anchor_a), 1e-14);
    }
  }
}

TEST(Manifold, IdsAndNormalStayWhileBoxesRock) {
  const ConvexShape below = boxShape(0.5, 0.5), above = boxShape(0.5, 0.5);
  SplitMix64 random(7);
  Manifold first;
  ASSERT_TRUE(collide(below, {}, above, {}, {0.1, -0.999}, 0.05, first));
  ReferenceFace kept = first.reference;
  for (int i = 0; i < 10000; ++i) {
    const Rotation qa = rotationBy(between(random, -1e-5, 1e-5)),
                   qb = rotationBy(between(random, -1e-5, 1e-5));
    const RotatedShape a = rotated(below, qa), b = rotated(above, qb);
    Manifold m;
    ASSERT_TRUE(collide(a, b, {0.1, -0.999 + between(random, -1e-4, 1e-4)}, 0.05, kept, m));
    EXPECT_EQ(m.reference, first.reference);
    ASSERT_EQ(m.count, 2);
    EXPECT_EQ(m.points[0].id, first.points[0].id);
    EXPECT_EQ(m.points[1].id, first.points[1].id);
    EXPECT_LE(length(m.normal - first.normal), 2e-5);
    kept = m.reference;
    // Without a kept one, the reference face may change, but not the ids of the corners that touch.
    ASSERT_TRUE(collide(a, b, {0.1, -0.999}, 0.05, {}, m));
    ASSERT_EQ(m.count, 2);
    const auto has = [&](std::uint32_t id) { return m.points[0].id == id || m.points[1].id == id; };
    EXPECT_TRUE(has(first.points[0].id) && has(first.points[1].id));
  }
}

TEST(Manifold, WrongCachedFaceDoesNoHarm) {
  const RotatedShape box = rotated(boxShape(0.5, 0.5), {});
  for (const auto owner : {ReferenceFace::Owner::kA, ReferenceFace::Owner::kB}) {
    for (int edge = 0; edge < 255; ++edge) {
      Manifold m;
      ASSERT_TRUE(collide(box, box, {0.25, -0.99}, 0, {owner, static_cast<std::uint8_t>(edge)}, m));
      EXPECT_EQ(m.normal, (Vec2{0, -1}));
      EXPECT_NEAR(smallest(m), -0.01, 1e-15);
    }
  }
}

TEST(Manifold, ConcentricCirclesHaveANormal) {
  const ConvexShape circle = test::circleShape(0.5);
  Manifold m;
  ASSERT_TRUE(collide(circle, {}, circle, {}, {}, 0, m));
  EXPECT_EQ(length(m.normal), 1);
  EXPECT_EQ(m.points[0].separation, -1);
}

// All geometry functions together have one hash, for every compiler and optimisation level.
TEST(Manifold, GeometryHashIsTheSameOnEveryPlatform) {
  SplitMix64 random(1);
  test::BitHash hash;
  BroadPhase broad;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const ConvexShape a = test::anyShape(random), b = test::anyShape(random);
    const RigidMotion motion_a = {test::anyVec(random, 5), test::anyRotation(random),
                                  test::between(random, -3, 3)};
    const RigidMotion motion_b = {test::anyVec(random, 5), test::anyRotation(random),
                                  test::between(random, -3, 3)};
    const Vec2 offset = test::anyVec(random, 2);
    const Mass mass = massOf(a, 2);
    hash.add(mass.mass), hash.add(mass.inertia), hash.add(mass.centre);
    Manifold m;
    if (collide(a, motion_a.start, b, motion_b.start, offset, 0.1, m)) {
      hash.add(m.normal);
      for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
        hash.add(m.points[k].anchor_a), hash.add(m.points[k].separation),
            hash.add(std::uint64_t{m.points[k].id});
      }
    }
    const TimeOfImpact impact = timeOfImpact(a, motion_a, b, motion_b, 3 * offset);
    hash.add(impact.time), hash.add(impact.gap), hash.add(impact.normal);
    const RayHit hit = castRay(a, offset, motion_a.displacement);
    hash.add(hit.fraction), hash.add(hit.normal);
    const Bounds bounds = boundsOf(rotated(a, motion_a.start));
    broad.add(i, gridBounds(placeAt(10 * offset), bounds, 0.1), true);
  }
  for (const BroadPhasePair& pair : broad.updatePairs()) hash.add(std::uint64_t{pair.id_a} << 32 | pair.id_b);
  EXPECT_EQ(hash.value(), 9358134255254305601U);
}

}  // namespace
}  // namespace naiad::physics
