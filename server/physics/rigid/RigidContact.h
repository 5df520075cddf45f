// How two shapes that touch keep out of one another: what is remembered of them from step to step, and what
// is solved for within one.
#pragma once

#include <array>
#include <cstdint>

#include "physics/geometry/Manifold.h"

namespace naiad::physics {

/// A body within a step. What the solver reads and writes for each contact is in its first cache line.
struct alignas(64) RigidState {
  Vec2 velocity;
  double spin = 0;
  double inverse_mass = 0;  ///< both 0 for what nothing pushes
  double inverse_inertia = 0;
  Vec2 push;             ///< a velocity that undoes overlap, for one sub-step
  double push_spin = 0;  ///< likewise
  Vec2 displacement;     ///< from where the step began
  Rotation turn;         ///< likewise
  Vec2 kick;             ///< what half a sub-step of acceleration adds to the velocity
  double spin_kick = 0;  ///< likewise
  Vec2 kick_growth;      ///< from one sub-step to the next
  bool is_pushed = false;
};

/// Of a pair of shapes whose bodies' bounds overlap. Kept from step to step.
struct RigidContact {
  std::int32_t next = -1;  ///< of the same pair of bodies, or the next free one
  std::int32_t shape_a = 0;
  std::int32_t shape_b = 0;
  ReferenceFace reference;
  std::int32_t count = 0;  ///< of the points remembered
  std::array<std::uint32_t, 2> id = {};
  std::array<double, 2> normal_impulse = {};  ///< of a sub-step, per its length
  std::array<double, 2> friction_impulse = {};
};

/// Which feature the normal goes with.
enum class ContactKind : std::uint8_t { kFaceA, kFaceB, kPoints };

/// A point of a contact within a step: what the solver goes through again and again comes first.
struct alignas(64) ContactPoint {
  // Levers about both centres: of the normal and of the tangent.
  double normal_a = 0, normal_b = 0, tangent_a = 0, tangent_b = 0;
  double normal_mass = 0, tangent_mass = 0;
  double normal_impulse = 0;                  ///< of the sub-step so far; between sub-steps, of the last one
  double friction_impulse = 0;                ///< likewise
  double normal_resistance = 0;               ///< 1 / normal_mass; 0 if that is
  double normal_warm = 0, friction_warm = 0;  ///< what each half of the sub-step starts from
  double target = 0;                          ///< normal speed before the bodies go on …
  double after = 0;                           ///< … and after; only the second if they bounce
  double push = 0, push_impulse = 0;          ///< to undo overlap
  double separation = 0;
  double total = 0;     ///< normal impulse of the step so far
  Vec2 core_a, core_b;  ///< the cores' points at the start of the step
  double base = 0;      ///< separation less what the cores say
  std::uint32_t id = 0;
  bool is_bouncing = false;
  bool is_bending = false;  ///< it would bounce, but its path is no parabola
};

/// A contact within a step. In the order of ContactPoint.
struct alignas(64) ContactConstraint {
  std::int32_t a = 0, b = 0;
  std::int32_t count = 0;
  ContactKind kind = ContactKind::kPoints;
  bool may_fly = false;  ///< what turns and bounces goes from impact to impact
  bool is_deep = false;  ///< there is overlap to undo
  Vec2 normal;           ///< now
  double friction = 0;
  double coupling = 0;             ///< of two normals
  double inverse_determinant = 0;  ///< of their matrix; 0: one after the other
  std::array<ContactPoint, 2> points;
  Vec2 first_normal;  ///< at the start of the step
  Vec2 offset;        ///< from A to B at the start of the step
  double radius_a = 0, radius_b = 0;
  double restitution = 0;
  double slop = 0;            ///< overlap that is left
  double max_push_speed = 0;  ///< the greatest speed at which overlap is undone
  double first_time = -1;     ///< within the step, when the first impulse was exchanged
  std::int32_t pair = -1;     ///< −1: found within the step
  std::int32_t contact = -1;  ///< likewise
};

}  // namespace naiad::physics
