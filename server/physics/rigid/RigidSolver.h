// The contacts of a step as constraints on velocities, in sub-steps that are each a velocity Verlet step:
// half a kick, velocities that lead to no overlap, the bodies move, half a kick, velocities that fit where
// they now are. (RATTLE's two stages, with inequalities.) Impulses are found by sweeps of Gauss and Seidel
// that start from the last sub-step's; the two normal impulses of a manifold together.
#pragma once

#include <span>

#include "physics/geometry/ConvexShape.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

/// Writes everything but body indices, material and impulses: at the start of a step. `offset` is from A's
/// origin to B's.
void beginConstraint(const TurnedShape& a, const TurnedShape& b, Vec2 offset, const Manifold& manifold,
                     ContactConstraint& constraint);

/// Puts a constraint that was found within the step into the coordinates of the start of the step, when B was
/// `start` from A.
void measureFromStart(ContactConstraint& constraint, Vec2 start, const RigidState& a, const RigidState& b);

/// Where it is now, and the masses that follow from it.
void refresh(ContactConstraint& constraint, std::span<const RigidState> bodies);

/// Before a sub-step over `h`: sets the normal speeds that it must lead to. Applies no impulse. Is there
/// overlap to undo? A point that will bounce within the sub-step gets its time of impact here, by a
/// quadratic: along the normal of a known contact it falls with a constant acceleration, so it needs no
/// search (TimeOfImpact.h).
bool beginSubstep(ContactConstraint& constraint, std::span<const RigidState> bodies, double h);
/// After half a kick: half of the last impulses.
void beginFirstHalf(ContactConstraint& constraint, std::span<RigidState> bodies);
/// Undoes some of the overlap, by a velocity that is forgotten after the sub-step.
void pushApart(ContactConstraint& constraint, std::span<RigidState> bodies);
/// After the bodies moved: the same for the second half.
void beginSecondHalf(ContactConstraint& constraint, std::span<RigidState> bodies, double h);

/// One visit. `is_second`: of the second half. Returns the greatest change of a normal speed.
double solveContact(ContactConstraint& constraint, std::span<RigidState> bodies, bool is_second);

}  // namespace naiad::physics
