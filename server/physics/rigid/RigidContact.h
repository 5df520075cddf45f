// Contacts of two shapes: the data kept from step to step, and the data of the solver within a step.
#pragma once

#include <array>
#include <cstdint>

#include "physics/geometry/Manifold.h"

namespace naiad::physics {

/// A body within a step. The first cache line has all that the solver reads for each contact.
struct alignas(64) RigidState {
  Vec2 velocity;
  double spin = 0;
  double inverse_mass = 0;  ///< 0 for immovable bodies, as is inverse_inertia
  double inverse_inertia = 0;
  Vec2 push;               ///< velocity that undoes overlap, only for one sub-step
  double push_spin = 0;    ///< spin that undoes overlap, for one sub-step
  Vec2 kick;               ///< change of the velocity by half a sub-step of acceleration
  double spin_kick = 0;    ///< change of the spin by half a sub-step of torque
  Vec2 velocity_before;    ///< velocity before the impulses of this half of the sub-step
  double spin_before = 0;  ///< spin before the impulses of this half of the sub-step
  double mass = 0;         ///< 0 for immovable bodies, as is `inertia`
  double inertia = 0;
  Vec2 displacement;   ///< movement since the beginning of the step
  Rotation turn;       ///< rotation since the beginning of the step
  Vec2 kick_growth;    ///< change of `kick` from one sub-step to the next
  Vec2 free_velocity;  ///< velocity in the middle of the sub-step if nothing pushes the body
  bool is_pushed = false;

  void setMass(double inverse, double inverse_of_inertia) {
    inverse_mass = inverse;
    inverse_inertia = inverse_of_inertia;
    mass = inverse > 0 ? 1 / inverse : 0;
    inertia = inverse_inertia > 0 ? 1 / inverse_inertia : 0;
  }
};

/// Sets the kicks of a body for sub-steps of length h. They grow steadily with `jerk`, from below their mean
/// to above it. The factor square / (square − 1) corrects the error of half kicks, so that the path ends
/// where it does with a steadily growing acceleration.
inline void setKick(RigidState& state, Vec2 acceleration, Vec2 jerk, double h, double substeps) {
  state.kick = (0.5 * h) * acceleration;
  if (jerk == Vec2{} || substeps < 2) return;
  const double square = substeps * substeps;
  state.kick_growth = (0.5 * h * h * square / (square - 1)) * jerk;
  state.kick -= (0.5 * (substeps - 1)) * state.kick_growth;
}

/// A contact of two shapes whose bodies' bounds overlap. It is kept from step to step.
struct RigidContact {
  std::int32_t next = -1;  ///< index of the next contact of these bodies, or of the next free entry
  std::int32_t shape_a = 0;
  std::int32_t shape_b = 0;
  ReferenceFace reference;
  bool is_ballistic = false;  ///< the sweep must find its impacts in this sub-step
  bool rests = false;         ///< a point presses or rests in this sub-step
  std::int32_t count = 0;     ///< number of points whose impulses are known
  std::array<std::uint32_t, 2> id = {};
  std::array<double, 2> normal_impulse = {};  ///< impulse of a sub-step divided by its length
  std::array<double, 2> friction_impulse = {};
};

/// The features that the normal follows: an edge of A, an edge of B, or the two points.
enum class ContactKind : std::uint8_t { kFaceA, kFaceB, kPoints };

/// A contact point within a step. Fields that the solver uses most come first.
struct alignas(64) ContactPoint {
  // Levers of the normal and of the tangent about the centres of A and B.
  double normal_a = 0, normal_b = 0, tangent_a = 0, tangent_b = 0;
  double normal_mass = 0, tangent_mass = 0;
  double normal_impulse = 0;                  ///< in this sub-step so far; between sub-steps, of the last one
  double friction_impulse = 0;                ///< in this sub-step so far; between sub-steps, of the last one
  double normal_resistance = 0;               ///< 1 / normal_mass; 0 if normal_mass is 0
  double normal_warm = 0, friction_warm = 0;  ///< first guess of the impulses for each half of the sub-step
  double target = 0;                          ///< normal speed to reach before the bodies move
  double after = 0;                           ///< normal speed to reach after the move, or at an impact
  double push = 0, push_impulse = 0;          ///< velocity change and impulse that undo overlap
  double separation = 0;
  double total = 0;     ///< normal impulse of the step up to now
  Vec2 core_a, core_b;  ///< the two points on the cores at the start of the step
  double base = 0;      ///< separation minus that of the points core_a and core_b
  std::uint32_t id = 0;
  bool is_bouncing = false;
  bool is_bending = false;  ///< it would bounce, but the path to the impact is not a parabola
};

/// Impulses of a contact: of its two points along the normal, then along the tangent.
using ContactImpulses = std::array<double, 4>;

/// A contact within a step. Fields are ordered as in ContactPoint.
struct alignas(64) ContactConstraint {
  std::int32_t a = 0, b = 0;
  std::int32_t count = 0;
  ContactKind kind = ContactKind::kPoints;
  bool may_fly = false;  ///< both bodies may be swept
  bool is_deep = false;  ///< true if there is overlap to undo
  bool is_kept = false;  ///< true if the bodies touched in the last step
  /// True in sub-steps in which the shapes fly freely between impacts: the sweep finds and resolves them at
  /// their times (RigidSweep.cpp), and the solver ignores the contact.
  bool is_ballistic = false;
  bool overlaps = false;  ///< true if the shapes overlapped when the contact was found in this step
  Vec2 normal;            ///< normal at the present positions
  double friction = 0;
  double coupling = 0;             ///< coupling of the two points' normals
  double inverse_determinant = 0;  ///< of the two normals' matrix; 0: they are solved one after the other
  std::array<ContactPoint, 2> points;
  Vec2 first_normal;     ///< normal at the start of the step
  double first_gap = 0;  ///< smallest separation at the start of the step
  Vec2 offset;           ///< displacement from A to B at the start of the step
  double radius_a = 0, radius_b = 0;
  double restitution = 0;
  double slop = 0;              ///< depth of overlap that is not undone
  double max_push_speed = 0;    ///< maximum speed at which overlap is undone
  double first_time = -1;       ///< time of the first impulse within the step; −1: none
  ContactImpulses before = {};  ///< impulses of this sub-step before its present half
  std::int32_t pair = -1;       ///< index of the pair; −1: found within the step
  std::int32_t contact = -1;    ///< index of the kept contact; −1: found within the step
};

}  // namespace naiad::physics
