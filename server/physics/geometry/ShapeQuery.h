// Queries on one shape: point inside, nearest surface point, ray hit.
//
// All arguments and results are in the body's axes, relative to its origin. Convert a world point by
// `inverse(rotation) * (point − place)`, and a resulting direction by `rotation * direction`.
#pragma once

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// True if the point is in the shape, border included, within rounding.
bool contains(const ConvexShape& shape, Vec2 point);

struct SurfacePoint {
  Vec2 point;           ///< a point of the surface
  Vec2 normal;          ///< unit length, outward
  double distance = 0;  ///< distance from the surface; negative inside
};
/// Returns the surface point nearest to `point`; for a point inside, the one across the nearest edge.
SurfacePoint closestPoint(const ConvexShape& shape, Vec2 point);

struct RayHit {
  bool hit = false;
  double fraction = 0;  ///< part of the displacement up to the hit; 0 if the ray starts inside
  Vec2 normal;          ///< unit length, outward at the hit; zero if the ray starts inside
};
/// Returns where a point that moves from `from` by `displacement` (not zero, up to 1e9 cells) first hits the
/// shape: the time of impact for points. A ray that only grazes the shape may count as a hit or not.
RayHit castRay(const ConvexShape& shape, Vec2 from, Vec2 displacement);

}  // namespace naiad::physics
