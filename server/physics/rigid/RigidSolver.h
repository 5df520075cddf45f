// The contacts of a step as velocity constraints. Each sub-step is a velocity Verlet step: half a kick,
// velocities that lead to no overlap, the bodies move, half a kick, velocities that fit the new positions.
// (These are RATTLE's two stages, with inequalities.) Gauss–Seidel sweeps find the impulses, starting from
// those of the last sub-step; the two normal impulses of a manifold are solved together.
#pragma once

#include <span>

#include "physics/geometry/ConvexShape.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

/// Call at the start of a step: sets everything except body indices, material and impulses. `offset` is from
/// A's origin to B's.
void beginConstraint(const RotatedShape& a, const RotatedShape& b, Vec2 offset, const Manifold& manifold,
                     ContactConstraint& constraint);

/// Converts a constraint that was found within the step to the coordinates of the start of the step, when B
/// was at `start` relative to A.
void measureFromStart(ContactConstraint& constraint, Vec2 start, const RigidState& a, const RigidState& b);

/// Updates the position and the masses that depend on it.
void refresh(ContactConstraint& constraint, std::span<const RigidState> bodies);

/// Call before a sub-step over `h`: sets the normal speeds to reach, without applying impulses. Returns true
/// if there is overlap to undo. A point that will bounce within the sub-step gets its time of impact here by
/// a quadratic formula: along a known normal it falls with a constant acceleration, so no search is needed
/// (TimeOfImpact.h).
bool beginSubstep(ContactConstraint& constraint, std::span<const RigidState> bodies, double h);
/// Call after half a kick: applies half of the last impulses.
void beginFirstHalf(ContactConstraint& constraint, std::span<RigidState> bodies);
/// Undoes some of the overlap, by a velocity that is dropped after the sub-step.
void pushApart(ContactConstraint& constraint, std::span<RigidState> bodies);
/// Like beginFirstHalf(), for the second half; call after the bodies moved.
void beginSecondHalf(ContactConstraint& constraint, std::span<RigidState> bodies, double h);

/// Solves the contact once; `is_second`: in the second half. Returns the largest change of a normal speed.
double solveContact(ContactConstraint& constraint, std::span<RigidState> bodies, bool is_second);

}  // namespace naiad::physics
