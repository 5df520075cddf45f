// The contacts of a step as velocity constraints. Each sub-step is a velocity Verlet step: half a kick,
// velocities that lead to no overlap, the bodies move, half a kick, velocities that fit the new positions.
// (These are RATTLE's two stages, with inequalities.) Gauss–Seidel sweeps find the impulses, starting from
// those of the last sub-step; the two normal impulses of a manifold are solved together.
#pragma once

#include <span>

#include "physics/geometry/ConvexShape.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

/// Call at the start of a step: sets the geometry, and the points with impulses of zero, but not the bodies,
/// their material or the pair. `offset` is from A's origin to B's.
void beginConstraint(const RotatedShape& a, const RotatedShape& b, Vec2 offset, const Manifold& manifold,
                     ContactConstraint& constraint);

/// Converts a constraint that was found within the step to the coordinates of the step's start, when B was at
/// `start` relative to A.
void measureFromStart(ContactConstraint& constraint, Vec2 start, const RigidState& a, const RigidState& b);

/// Updates the separations for the present positions, and the masses that depend on them.
void refresh(ContactConstraint& constraint, std::span<const RigidState> bodies);

/// Call before a sub-step over `h`: sets the normal speeds to reach, without applying impulses. Returns true
/// if there is overlap to undo. A contact with restitution that does not press is ballistic. If its bodies
/// cannot be swept, because of joints or a large group, a quadratic formula predicts the bounce, as if the
/// bodies did not turn.
bool beginSubstep(ContactConstraint& constraint, std::span<const RigidState> bodies, double h);
/// Returns the speed at or below which a bounce ends at rest, because its flight would be too short.
double restSpeed(const ContactConstraint& constraint, std::span<const RigidState> bodies);
/// Resolves an impact at the present positions and velocities, without friction. The points that approach
/// are solved together: each leaves with restitution × its speed of approach, or is pushed by the others.
/// This is repeated for points that approach then, so with a restitution of 1 the energy is kept to rounding.
/// A point that would leave at most at `rest_speed` gets the speed `rest_after` instead. Returns true if one
/// did.
bool bounce(ContactConstraint& constraint, std::span<RigidState> bodies, double rest_speed,
            double rest_after);
/// Call after half a kick: applies half of the last impulses.
void beginFirstHalf(ContactConstraint& constraint, std::span<RigidState> bodies);
/// Undoes a part of the overlap by a velocity that is dropped after the sub-step.
void pushApart(ContactConstraint& constraint, std::span<RigidState> bodies);
/// Like beginFirstHalf(), for the second half; call after the bodies moved.
void beginSecondHalf(ContactConstraint& constraint, std::span<RigidState> bodies, double h);

/// Sets the impulses of this half to zero, and to zero their first guess for both halves.
void dropGuess(ContactConstraint& constraint);
/// Applies the first guess of this half again, multiplied by `part`, to the velocities before the half.
void restart(ContactConstraint& constraint, std::span<RigidState> bodies, double part);
/// Multiplies the impulses of this half by `part`, but not the velocities that they caused.
void scale(ContactConstraint& constraint, double part);
/// Returns the energy that moving surfaces add by the impulses of this half.
double inputOf(const ContactConstraint& constraint, std::span<const RigidState> bodies);

/// Solves the contact once, in the second half if `is_second`. Returns the largest change of a normal speed.
double solveContact(ContactConstraint& constraint, std::span<RigidState> bodies, bool is_second);

}  // namespace naiad::physics
