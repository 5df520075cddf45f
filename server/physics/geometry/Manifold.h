// Where and how two convex shapes touch: a normal and up to two points.
//
// All input and output is relative to the bodies' origins, so a pair at 1e9 cells gives the bits of the same
// pair at the origin. What lies along the axes is exact: a box that hovers by 2^-20 is reported to do so.
#pragma once

#include <array>
#include <cstdint>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct ManifoldPoint {
  Vec2 anchor_a;          ///< midway between the surfaces, from A's origin, in the axes of the world
  Vec2 anchor_b;          ///< the same point from B's origin
  double separation = 0;  ///< along the normal; > 0 is a gap
  /// Which corners touch here: vertex of A, vertex of B. The same while the contact lasts, whichever edge the
  /// normal is taken from, so that a solver can go on from the last step's impulse.
  std::uint32_t id = 0;
};

/// The edge that the normal is taken from. Handed back in the next step, it is kept until another one is
/// clearly better, so that rounding does not make the normal jump between equal ones.
struct ReferenceFace {
  enum class Owner : std::uint8_t { kNone, kA, kB };
  Owner owner = Owner::kNone;
  std::uint8_t edge = 0;
  friend constexpr bool operator==(ReferenceFace a, ReferenceFace b) = default;
};

/// A kept edge may be worse than the best by this part of the smaller shape's reach: far above rounding, far
/// below what is seen.
inline constexpr double kFaceHysteresis = 1e-3;

struct Manifold {
  Vec2 normal;  ///< of length one, from A to B
  std::int32_t count = 0;
  std::array<ManifoldPoint, 2> points;
  ReferenceFace reference;
};

/// `offset` is from A's origin to B's, a difference of two places. Points with a gap beyond `speculative` are
/// left out. Without `kept` the smallest separation is exact; with it, within the hysteresis. Returns whether
/// there is a point; if not, of `manifold` only the count is written. `prefers_faces`: two polygons whose
/// nearest points are corners, yet of which one has an edge in front of the other's, get the two points of
/// these edges; which corner is the nearest one may be another one before they meet.
bool collide(const TurnedView& a, const TurnedView& b, Vec2 offset, double speculative, ReferenceFace kept,
             Manifold& manifold, bool prefers_faces = false);

/// For a pair that is tested once: turns the shapes first.
bool collide(const ConvexShape& a, Rotation rotation_a, const ConvexShape& b, Rotation rotation_b,
             Vec2 offset, double speculative, Manifold& manifold);

}  // namespace naiad::physics
