// Random shapes of every kind, and reference functions for them, which are slow but simple.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/Shapes.h"

namespace naiad::physics::test {

inline double between(SplitMix64& random, double low, double high) {
  return low + (high - low) * random.unit();
}

inline Vec2 anyVec(SplitMix64& random, double most) {
  return {between(random, -most, most), between(random, -most, most)};
}

inline Rotation anyRotation(SplitMix64& random) {
  return rotationBy(between(random, -3.14, 3.14));
}

inline RotatedShape rotated(const ConvexShape& shape, const Rotation& by) {
  RotatedShape its;
  turn(shape, by, its);
  return its;
}

/// Returns the corners of the convex hull, ordered from x to y (A. Andrew's monotone chains).
inline std::vector<Vec2> hullOf(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Vec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const Vec2 p : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Returns a circle, capsule, box or polygon, sharp or rounded, of size about 1. Half of the shapes are not
/// centred on their origin.
inline ConvexShape anyShape(SplitMix64& random) {
  for (;;) {
    ConvexShape shape;
    const Vec2 centre = random.unit() < 0.5 ? Vec2{} : anyVec(random, 1);
    const double radius = random.unit() < 0.5 ? 0 : between(random, 0.01, 0.5);
    ShapeStatus status = ShapeStatus::kTooFew;
    const double kind = random.unit();
    // Draws the numbers before the calls, because compilers evaluate arguments in different orders.
    const double first = between(random, 0.1, 1), second = between(random, 0.1, 1);
    if (kind < 0.2) {
      status = makeCircle(first, centre, shape);
    } else if (kind < 0.4) {
      status = makeCapsule(centre, centre + anyVec(random, 1), 0.5 * second, shape);
    } else if (kind < 0.6) {
      status = makeBox(first, second, centre, anyRotation(random), radius, shape);
    } else {
      std::vector<Vec2> points;
      const int count = 3 + static_cast<int>(random.unit() * 20);
      for (int i = 0; i < count; ++i) points.push_back(centre + anyVec(random, 1));
      status = makePolygon(hullOf(points), radius, shape);
    }
    if (status == ShapeStatus::kOk) return shape;
  }
}

inline double pointToSegment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 e = b - a;
  const double whole = lengthSquared(e);
  const double t = whole > 0 ? std::clamp(dot(p - a, e) / whole, 0.0, 1.0) : 0;
  return length(p - (a + t * e));
}

inline std::vector<Vec2> placed(const ConvexShape& shape, Rotation q, Vec2 by) {
  std::vector<Vec2> points;
  for (int i = 0; i < shape.count; ++i)
    points.push_back(by + q * shape.vertices[static_cast<std::size_t>(i)]);
  return points;
}

inline bool inCore(const std::vector<Vec2>& core, Vec2 p) {
  if (core.size() < 3) return false;
  for (std::size_t i = 0; i < core.size(); ++i) {
    if (cross(core[(i + 1) % core.size()] - core[i], p - core[i]) < 0) return false;
  }
  return true;
}

inline bool crossing(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  // If all points are on one line, the products below are only rounding errors.
  const double from = std::min(dot(c - a, b - a), dot(d - a, b - a)),
               to = std::max(dot(c - a, b - a), dot(d - a, b - a));
  if (from > lengthSquared(b - a) || to < 0) return false;
  return cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0;
}

/// Returns the distance of two cores by testing every corner against every edge; 0 if they overlap.
inline double slowDistance(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  if (inCore(a, b[0]) || inCore(b, a[0])) return 0;
  double best = 1e300;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Vec2 a1 = a[i], a2 = a[(i + 1) % a.size()], b1 = b[j], b2 = b[(j + 1) % b.size()];
      if (crossing(a1, a2, b1, b2)) return 0;
      best = std::min({best, pointToSegment(a1, b1, b2), pointToSegment(b1, a1, a2)});
    }
  }
  return best;
}

/// Returns the gap between the surfaces; ≤ 0 if they overlap, and −(sum of the radii) if the cores overlap.
inline double slowGap(const ConvexShape& a, Rotation qa, const ConvexShape& b, Rotation qb, Vec2 offset) {
  return slowDistance(placed(a, qa, {}), placed(b, qb, offset)) - (a.radius + b.radius);
}

}  // namespace naiad::physics::test
