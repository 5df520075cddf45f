// When two convex shapes that move and turn first touch.
//
// The time-of-impact finder for what turns: any convex shapes, straight and evenly turning over a sub-step.
// No formula gives that moment. ImpactTime.h has one, for boxes and circles that do not turn; ShapeQuery.h
// casts a point, for soft bodies' nodes; JointImpacts.h follows paths that joints bend.
//
// Conservative advancement. At each stop the separating axis is known; along it, the gap at any later time is
// at least what every pair of corners would leave if it went straight on, less the most that turning can bend
// its path. What turns fast is a disc until it has come near, so that turns before that cost nothing. The
// first time at which that bound is used up is safe to go to, so nothing is ever passed, and because the
// bound is right to second order, the steps converge like Newton's. Cf. B. Mirtich, "Impulse-based dynamic
// simulation of rigid body systems", 1996, and X. Zhang, M. Lee, Y. J. Kim, "Interactive continuous collision
// detection for non-convex polyhedra", 2006.
#pragma once

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// From time 0 to time 1: the origin moves straight, the body turns evenly about it.
struct RigidMotion {
  Vec2 displacement;
  Rotation start;
  double turn = 0;  ///< radians
};

enum class TimeOfImpactStatus : std::uint8_t {
  kApart,       ///< they do not touch
  kHit,         ///< they touch at `time`
  kUnresolved,  ///< still apart at `time`, and not known any further: out of iterations. To be counted.
};

struct TimeOfImpact {
  TimeOfImpactStatus status = TimeOfImpactStatus::kApart;
  bool touched_before = false;  ///< they touched or overlapped at time 0
  double time = 1;              ///< never late
  double gap = 0;               ///< between the surfaces at `time`, if they hit
  Vec2 normal;                  ///< of length one, from A to B at `time`, if they hit
  std::int32_t iterations = 0;
};

/// The most of 1.5 million random sweeps was 106 (docs/physics/shapes.md).
inline constexpr std::int32_t kImpactIterations = 200;

/// How near counts as touching, for shapes of this size and this far from each other.
double impactTolerance(const ConvexShape& a, const ConvexShape& b, Vec2 offset, Vec2 relative_displacement);

/// The first time in [0, 1] at which the gap is at most `target` (>= 0), found when it is within the
/// tolerance of it. A pair that is as near as that at time 0 hits when it has come nearer by another four
/// tolerances: one that slides, rests or separates does not. `offset` is from A's origin to B's at time 0;
/// everything is finite and the displacements are up to 1e9 cells.
TimeOfImpact timeOfImpact(const ConvexShape& a, const RigidMotion& motion_a, const ConvexShape& b,
                          const RigidMotion& motion_b, Vec2 offset, double target = 0);

}  // namespace naiad::physics
