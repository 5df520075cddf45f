// Questions about one shape: is a point in it, what is nearest on it, where does a ray hit it.
//
// All of them are asked in the body's own axes, relative to its origin. A point of the world comes in as
// `inverse(rotation) * (point − place)`, and directions go out as `rotation * direction`.
#pragma once

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// The border belongs to the shape, within rounding.
bool contains(const ConvexShape& shape, Vec2 point);

struct SurfacePoint {
  Vec2 point;           ///< on the surface
  Vec2 normal;          ///< of length one, outward there
  double distance = 0;  ///< from the surface; negative inside
};
/// The nearest point of the surface, for points outside; inside, that across the nearest edge.
SurfacePoint closestPoint(const ConvexShape& shape, Vec2 point);

struct RayHit {
  bool hit = false;
  double fraction = 0;  ///< of the displacement; 0 if it starts inside
  Vec2 normal;          ///< of length one, outward at the hit; zero if it starts inside
};
/// Where a point that moves from `from` by `displacement` (not zero, up to 1e9 cells) first hits the shape:
/// the time-of-impact finder for points. One that merely touches may count as either.
RayHit castRay(const ConvexShape& shape, Vec2 from, Vec2 displacement);

}  // namespace naiad::physics
