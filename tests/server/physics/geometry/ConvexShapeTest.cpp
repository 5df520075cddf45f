#include <limits>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Mass.h"
#include "physics/geometry/ShapeQuery.h"
#include "physics/geometry/ShapeRaster.h"
#include "tests/server/physics/QuadReference.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr double kPi = df::math::kPi;

TEST(Rotation, QuarterAndZeroTurnsAreExact) {
  const Vec2 v = {0.1, -0.7};
  EXPECT_EQ((Rotation{0, 1} * v), perpendicular(v));
  EXPECT_EQ((Rotation{} * v), v);
  EXPECT_EQ(turned(Rotation{0.6, 0.8}, 0), (Rotation{0.6, 0.8}));
  EXPECT_EQ(renormalised(Rotation{0, -1}), (Rotation{0, -1}));
}

TEST(Rotation, TurningIsAccurateAndStaysNormalised) {
  for (const double angle : {1e-300, 1e-9, 1e-3, 0.0625, 0.1249999, 0.125, 0.2, 1.0, -3.0, -0.125, 100.0}) {
    Rotation q;
    for (int i = 1; i <= 10000; ++i) {
      q = turned(q, angle);
      ASSERT_NEAR(q.c * q.c + q.s * q.s, 1, 7e-16);
    }
    const Quad whole = static_cast<Quad>(angle) * 10000;
    const double off = std::fabs(
        static_cast<double>(static_cast<Quad>(q.c) * sinq(whole) - static_cast<Quad>(q.s) * cosq(whole)));
    EXPECT_LE(off, 3e-12) << angle;  // 10,000 rotations with an error of 3e-16 each
  }
}

TEST(ConvexShape, RefusesInvalidShapesAndKeepsTheOldOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  ConvexShape shape = test::circleShape(2);
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_EQ(makeCircle(bad, {}, shape), ShapeStatus::kNotFinite);
    EXPECT_EQ(makeCircle(1, {0, bad}, shape), ShapeStatus::kNotFinite);
    EXPECT_EQ(makeBox(bad, 1, {}, {}, 0, shape), ShapeStatus::kNotFinite);
    EXPECT_EQ(makeBox(1, 1, {bad, 0}, {}, 0, shape), ShapeStatus::kNotFinite);
    EXPECT_EQ(makeBox(1, 1, {}, {bad, 0}, 0, shape), ShapeStatus::kNotFinite);
    EXPECT_EQ(makeCapsule({0, bad}, {1, 0}, 1, shape), ShapeStatus::kNotFinite);
    const std::array<Vec2, 3> points = {Vec2{0, 0}, {1, 0}, {0, bad}};
    EXPECT_EQ(makePolygon(points, 0, shape), ShapeStatus::kNotFinite);
  }
  for (const double bad : {0.0, -1.0, 1e-7, 1e-310}) {
    EXPECT_EQ(makeCircle(bad, {}, shape), ShapeStatus::kTooSmall);
    EXPECT_EQ(makeBox(bad, 1, {}, {}, 0, shape), ShapeStatus::kTooSmall);
    EXPECT_EQ(makeCapsule({}, {1, 0}, bad, shape), ShapeStatus::kTooSmall);
  }
  EXPECT_EQ(makeCapsule({1, 1}, {1, 1}, 1, shape), ShapeStatus::kTooSmall);
  EXPECT_EQ(makeCircle(1e30, {}, shape), ShapeStatus::kTooLarge);
  EXPECT_EQ(makeBox(1, 1e30, {}, {}, 0, shape), ShapeStatus::kTooLarge);
  EXPECT_EQ(makeBox(1, 1, {1e30, 0}, {}, 0, shape), ShapeStatus::kTooLarge);
  EXPECT_EQ(makeBox(1, 1, {}, {}, -0.1, shape), ShapeStatus::kTooSmall);

  const auto polygon = [&](std::vector<Vec2> points) { return makePolygon(points, 0, shape); };
  EXPECT_EQ(polygon({{0, 0}, {1, 0}}), ShapeStatus::kTooFew);
  EXPECT_EQ(polygon(std::vector<Vec2>(17, Vec2{})), ShapeStatus::kTooMany);
  EXPECT_EQ(polygon({{0, 0}, {0, 1}, {1, 0}}), ShapeStatus::kClockwise);
  EXPECT_EQ(polygon({{0, 0}, {1, 0}, {2, 0}}), ShapeStatus::kTooSmall);
  EXPECT_NE(polygon({{0, 0}, {4, 0}, {2, 1e-12}}), ShapeStatus::kOk);
  EXPECT_NE(polygon({{-1e8, 0}, {1e8, 0}, {0, 1e-9}}), ShapeStatus::kOk);
  EXPECT_EQ(polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), ShapeStatus::kTooSmall);
  EXPECT_EQ(polygon({{0, 0}, {1, 0}, {2, 0}, {1, 1}}), ShapeStatus::kNotConvex);
  EXPECT_EQ(polygon({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}), ShapeStatus::kNotConvex);
  EXPECT_EQ(polygon({{0, 0}, {1e30, 0}, {0, 1}}), ShapeStatus::kTooLarge);
  std::vector<Vec2> star;
  for (int i = 0; i < 5; ++i) star.push_back({std::cos(i * 4 * kPi / 5), std::sin(i * 4 * kPi / 5)});
  EXPECT_EQ(polygon(star), ShapeStatus::kNotConvex);
  EXPECT_EQ(shape.count, 1);
  EXPECT_EQ(shape.radius, 2);
}

TEST(Mass, MatchesTextbookValues) {
  ConvexShape shape;
  Mass mass = massOf(test::boxShape(1.5, 0.5), 2);
  EXPECT_NEAR(mass.mass, 6, 1e-15);
  EXPECT_NEAR(mass.inertia, 6 * (9.0 + 1) / 12, 1e-14);
  EXPECT_LE(length(mass.centre), 1e-16);
  ASSERT_EQ(makeCircle(0.7, {3, 4}, shape), ShapeStatus::kOk);
  mass = massOf(shape, 1);
  EXPECT_NEAR(mass.mass, kPi * 0.49, 1e-15);
  EXPECT_NEAR(mass.inertia, mass.mass * 0.49 / 2, 1e-15);
  EXPECT_EQ(mass.centre, (Vec2{3, 4}));
  // A capsule is a rectangle and two half discs. The centre of each half disc is 4r/3π beyond its edge.
  const double r = 0.5, d = 2;
  ASSERT_EQ(makeCapsule({-1, 0}, {1, 0}, r, shape), ShapeStatus::kOk);
  mass = massOf(shape, 1);
  const double disc = kPi * r * r, bar = d * 2 * r, c = 4 * r / (3 * kPi);
  EXPECT_NEAR(mass.mass, disc + bar, 1e-14);
  EXPECT_NEAR(mass.inertia, bar * (d * d + 4 * r * r) / 12 + disc * (r * r / 2 + d * d / 4 + d * c), 1e-14);
  EXPECT_LE(length(mass.centre), 1e-15);
}

TEST(Mass, MatchesASumOverSamplePoints) {
  SplitMix64 random(2);
  for (int i = 0; i < 40; ++i) {
    const ConvexShape shape = anyShape(random);
    const Mass mass = massOf(shape, 1);
    const double h = 1.0 / 64;
    double area = 0, square = 0;
    Vec2 first;
    for (double x = -4; x < 4; x += h) {
      for (double y = -4; y < 4; y += h) {
        const Vec2 p = {x + h / 2, y + h / 2};
        if (!contains(shape, p)) continue;
        area += h * h;
        first += h * h * p;
        square += h * h * lengthSquared(p - mass.centre);
      }
    }
    EXPECT_NEAR(mass.mass, area, 0.01 + 0.01 * area);
    EXPECT_LE(length(mass.centre - first / area), 0.01 + 0.001 / area) << i;
    EXPECT_NEAR(mass.inertia, square, 0.01 + 0.02 * square);
  }
}

TEST(Mass, CompoundOfPartsHasTheWholesMass) {
  ConvexShape whole, parts[2];
  ASSERT_EQ(makeBox(1, 0.5, {3, 1}, {}, 0, whole), ShapeStatus::kOk);
  ASSERT_EQ(makeBox(0.25, 0.5, {2.25, 1}, {}, 0, parts[0]), ShapeStatus::kOk);
  ASSERT_EQ(makeBox(0.75, 0.5, {3.25, 1}, {}, 0, parts[1]), ShapeStatus::kOk);
  const Mass one = massOf(whole, 3);
  Mass both = massOf(parts, std::array<double, 2>{3, 3});
  EXPECT_NEAR(both.mass, one.mass, 1e-14);
  EXPECT_NEAR(both.inertia, one.inertia, 1e-13);
  EXPECT_LE(length(both.centre - one.centre), 1e-14);
  recentre(parts, both);
  EXPECT_EQ(both.centre, Vec2{});
  EXPECT_LE(length(massOf(parts, std::array<double, 2>{3, 3}).centre), 1e-15);
  // Overlaps count twice.
  EXPECT_NEAR(massOf(std::array<ConvexShape, 2>{whole, whole}, std::array<double, 2>{3, 3}).mass,
              2 * one.mass, 1e-13);
}

TEST(Mass, MovingTheShapeChangesOnlyTheCentre) {
  SplitMix64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const ConvexShape shape = anyShape(random);
    const Rotation q = anyRotation(random);
    const Vec2 by = anyVec(random, 5);
    const Mass before = massOf(shape, 1), after = massOf(moved(shape, q, by), 1);
    ASSERT_NEAR(after.mass, before.mass, 1e-12 * before.mass) << i;
    ASSERT_NEAR(after.inertia, before.inertia, 1e-12) << i;
    ASSERT_LE(length(after.centre - (q * before.centre + by)), 1e-12) << i;
  }
}

TEST(ShapeQuery, ClosestPointIsOnTheSurfaceAndNearest) {
  SplitMix64 random(4);
  for (int i = 0; i < 100000; ++i) {
    const ConvexShape shape = anyShape(random);
    const Vec2 p = anyVec(random, 3);
    const SurfacePoint at = closestPoint(shape, p);
    const std::vector<Vec2> core = test::placed(shape, {}, {});
    const double truth = test::slowDistance(core, {p}) - shape.radius;
    if (truth > -shape.radius) {
      ASSERT_NEAR(at.distance, truth, 1e-13) << i;
    }
    ASSERT_EQ(contains(shape, p), at.distance <= 0) << i;
    ASSERT_LE(length(p - at.point - at.distance * at.normal), 1e-13);
    if (at.distance > -shape.radius || core.size() < 3) {
      ASSERT_NEAR(test::slowDistance(core, {at.point}), shape.radius, 1e-12) << i;
    }
    ASSERT_NEAR(length(at.normal), 1, 1e-15);
  }
}

TEST(ShapeQuery, ARayStopsAtTheSurface) {
  SplitMix64 random(5);
  int hits = 0, misses = 0;
  for (int i = 0; i < 100000; ++i) {
    const ConvexShape shape = anyShape(random);
    const Vec2 from = anyVec(random, 4), displacement = anyVec(random, 8);
    const RayHit hit = castRay(shape, from, displacement);
    const std::vector<Vec2> core = test::placed(shape, {}, {});
    if (contains(shape, from)) {
      ASSERT_TRUE(hit.hit && hit.fraction == 0 && hit.normal == Vec2{});
      continue;
    }
    hit.hit ? ++hits : ++misses;
    if (hit.hit) {
      ASSERT_NEAR(closestPoint(shape, from + hit.fraction * displacement).distance, 0, 1e-12) << i;
      ASSERT_LT(dot(hit.normal, displacement), 0) << i;
      ASSERT_LE(length(closestPoint(shape, from + hit.fraction * displacement).normal - hit.normal), 1e-3)
          << i;
    }
    // The part of the ray before the hit is never nearer to the core than the radius, so it is not inside.
    const Vec2 end = from + (hit.hit ? hit.fraction : 1) * displacement;
    ASSERT_GE(test::slowDistance(core, {from, end}), shape.radius - 1e-12) << i;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_GT(misses, 10000);
}

TEST(ShapeQuery, DistantRayHitsAtTheRightPoint) {
  const ConvexShape shape = test::boxShape(0.5, 0.5);
  // Some of the rays hit near the corners.
  for (const double y : {0.0, 0.25, -0.5 + 1e-9, 0.5 - 1e-9}) {
    const RayHit hit = castRay(shape, {-1e6, y}, {1e9, 0});
    ASSERT_TRUE(hit.hit) << y;
    EXPECT_EQ(hit.normal, (Vec2{-1, 0}));
    EXPECT_NEAR(hit.fraction * 1e9, 1e6 - 0.5, 1e-6);
  }
  EXPECT_FALSE(castRay(shape, {-1e6, 0}, {-1e9, 0}).hit);
  EXPECT_FALSE(castRay(shape, {-2, 0}, {1, 0}).hit);
}

TEST(ShapeRaster, CoversCellsWithTheirCentreInside) {
  SplitMix64 random(6);
  std::vector<CellSpan> spans;
  long covered = 0;
  for (int i = 0; i < 3000; ++i) {
    ConvexShape shape = anyShape(random);
    const double size = between(random, 0.5, 8), aspect = random.unit() < 0.5 ? 2 : between(random, 0.5, 3);
    for (Vec2& v : shape.vertices) v *= size;
    shape.radius *= size;
    const Rotation q = anyRotation(random);
    const Vec2 centre = anyVec(random, 3);
    rasterise(rotated(shape, q), centre, aspect, spans);
    for (int row = -40; row <= 40; ++row) {
      const auto span =
          std::find_if(spans.begin(), spans.end(), [&](const CellSpan& s) { return s.row == row; });
      for (int column = -40; column <= 40; ++column) {
        const double distance =
            closestPoint(shape, inverse(q) * (Vec2{column * 1.0, row * aspect} - centre)).distance;
        if (std::fabs(distance) < 1e-12) continue;
        const bool is_in = span != spans.end() && span->first <= column && column <= span->last;
        covered += is_in;
        ASSERT_EQ(is_in, distance < 0) << i << ": " << column << ", " << row;
      }
    }
  }
  EXPECT_GT(covered, 50000);
}

TEST(ShapeRaster, HugeShapeIsClippedToTheLimit) {
  const RotatedShape placed = rotated(test::boxShape(1e6, 1e6), {});
  std::vector<CellSpan> spans;
  rasterise(placed, {}, 1, spans, 100);
  ASSERT_EQ(spans.size(), 201U);
  EXPECT_EQ(spans[0], (CellSpan{-100, -100, 100}));
  rasterise(placed, {1e12, 0}, 1, spans, 100);
  EXPECT_TRUE(spans.empty());
}

}  // namespace
}  // namespace naiad::physics
