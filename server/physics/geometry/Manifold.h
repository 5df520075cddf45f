// The contact of two convex shapes: a normal and up to two points.
//
// All input and output is relative to the bodies' origins, so a pair at 1e9 cells has the bits of an equal
// pair at the origin. Results for boxes along the axes are exact: a gap of 2^-20 under a box is found.
#pragma once

#include <array>
#include <cstdint>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct ManifoldPoint {
  Vec2 anchor_a;          ///< the point midway between the surfaces, relative to A's origin, in world axes
  Vec2 anchor_b;          ///< the same point relative to B's origin
  double separation = 0;  ///< distance along the normal; > 0: gap
  /// The corners that touch here: a vertex of A and a vertex of B. The id is constant while the contact
  /// lasts, whichever edge defines the normal, so that a solver can start from the last step's impulse.
  std::uint32_t id = 0;
};

/// The edge that defines the normal. If it is passed to the next step, it is kept until another edge is
/// clearly better, so that rounding does not switch the normal between equal edges.
struct ReferenceFace {
  enum class Owner : std::uint8_t { kNone, kA, kB };
  Owner owner = Owner::kNone;
  std::uint8_t edge = 0;
  friend constexpr bool operator==(ReferenceFace a, ReferenceFace b) = default;
};

/// The kept edge may be worse than the best one by this part of the smaller shape's reach. It is far above
/// rounding and far below what is visible.
inline constexpr double kFaceHysteresis = 1e-3;

struct Manifold {
  Vec2 normal;  ///< unit length, from A to B
  std::int32_t count = 0;
  std::array<ManifoldPoint, 2> points;
  ReferenceFace reference;
};

/// Finds the contact of `a` and `b`. `offset` is from A's origin to B's, a difference of two places. Drops
/// points with a gap above `speculative`. The smallest separation is exact without a kept edge, otherwise
/// within the hysteresis. Returns true if there is a point; otherwise only the count of `manifold`, 0, is
/// defined. If the nearest points of two polygons are corners, `prefers_faces` makes it return two points of
/// the facing edges instead, if there are two, because another corner may be nearest when they touch.
bool collide(const RotatedView& a, const RotatedView& b, Vec2 offset, double speculative, ReferenceFace kept,
             Manifold& manifold, bool prefers_faces = false);

/// Like collide() of views, but rotates the shapes first; for pairs that are tested only once.
bool collide(const ConvexShape& a, Rotation rotation_a, const ConvexShape& b, Rotation rotation_b,
             Vec2 offset, double speculative, Manifold& manifold);

}  // namespace naiad::physics
