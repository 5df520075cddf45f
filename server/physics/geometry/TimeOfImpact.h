// Finds when two moving and rotating convex shapes first touch.
//
// This is the time of impact for rotating bodies: any convex shapes that move on parabolas and rotate evenly
// over a sub-step, for which no formula exists. ImpactTime.h has a formula for boxes and circles that do not
// rotate; ShapeQuery.h is for points, as of soft bodies.
//
// The method is conservative advancement. At each stop the separating axis is known. The gap along this axis
// at any later time is at least the minimum over all pairs of corners if all of them moved straight, less the
// maximum by which rotation bends their paths. A fast rotating body is treated as a disc until it is near. It
// is safe to advance to the first time at which this bound reaches zero, so no contact is missed. Because the
// bound is exact to second order, the steps converge like Newton's method. See B. Mirtich, "Impulse-based
// dynamic simulation of rigid body systems", 1996, and X. Zhang, M. Lee, Y. J. Kim, "Interactive continuous
// collision detection for non-convex polyhedra", 2006.
#pragma once

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// Motion from time 0 to time 1: the origin moves by displacement · t + acceleration · t²/2, and the body
/// rotates evenly about it.
struct RigidMotion {
  Vec2 displacement;
  Rotation start;
  double turn = 0;  ///< radians
  Vec2 acceleration = {};

  Vec2 at(double time) const { return time * (displacement + (0.5 * time) * acceleration); }
};

enum class TimeOfImpactStatus : std::uint8_t {
  kApart,       ///< no contact
  kHit,         ///< contact at `time`
  kUnresolved,  ///< no contact until `time`; the iteration limit was reached, so later contacts are unknown.
                ///< The caller should count these.
};

struct TimeOfImpact {
  TimeOfImpactStatus status = TimeOfImpactStatus::kApart;
  bool touched_before = false;  ///< touched or overlapped already at time 0
  double time = 1;              ///< time of the contact; never too late
  double gap = 0;               ///< gap between the surfaces at `time`, for kHit
  Vec2 normal;                  ///< unit length, from A to B at `time`, for kHit
  std::int32_t iterations = 0;
};

/// Limit of iterations. The maximum in 1.5 million random sweeps was 106 (docs/physics/shapes.md).
inline constexpr std::int32_t kImpactIterations = 200;

/// Returns the distance that counts as touching for shapes of this size and distance.
double impactTolerance(const ConvexShape& a, const ConvexShape& b, Vec2 offset, Vec2 relative_displacement);

/// Finds the first time in [0, 1] at which the gap is at most `target` (>= 0), within the tolerance. A pair
/// that is this near at time 0 hits when it is nearer by three to four more tolerances; it does not hit if it
/// slides, rests or separates. It may also come nearer by `give`, until it overlaps by four times that.
/// `offset` is from A's origin to B's at time 0. All numbers must be finite and displacements at most 1e9
/// cells.
TimeOfImpact timeOfImpact(const ConvexShape& a, const RigidMotion& motion_a, const ConvexShape& b,
                          const RigidMotion& motion_b, Vec2 offset, double target = 0, double give = 0);

}  // namespace naiad::physics
