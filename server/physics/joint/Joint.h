// Joints between two bodies: plain data. Lengths are in metric cells; the unit of time is that of the
// caller's step, usually the tick.
//
// Each joint is one constraint; a hinge with limits and a motor is three joints on two bodies.
#pragma once

#include <cstdint>
#include <limits>

#include "physics/geometry/Place.h"
#include "physics/geometry/Rotation.h"

namespace naiad::physics {

enum class JointKind : std::uint8_t {
  kDistance,    ///< a rod: keeps the anchors `length` > 0 apart
  kRope,        ///< keeps the anchors at most `length` > 0 apart; does not bounce when it becomes taut
  kHinge,       ///< keeps the anchors together
  kWeld,        ///< like kHinge, without relative rotation
  kSlider,      ///< keeps b's anchor on the line along `axis` through a's anchor, without relative rotation
  kSpring,      ///< pulls the anchors to a distance of `length` >= 0 with `stiffness` and `damping`
  kMotor,       ///< turns b relative to a at `speed`, with a torque of at most `max_force`
  kAngleLimit,  ///< keeps the angle of b relative to a, from `reference`, in [lower, upper], inside (−π, π)
  kMouse,       ///< a damped spring of length 0 from `target` to b's anchor, at most `max_force` on each axis
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Joint {
  JointKind kind = JointKind::kDistance;
  int a = -1;  ///< index of a body; unused by kMouse
  int b = -1;
  Vec2 anchor_a;  ///< position relative to the centre of a, in the frame of a
  Vec2 anchor_b;
  double length = 0;
  Vec2 axis = {1, 0};    ///< unit length, in the frame of a
  Rotation reference;    ///< rotation of b in the frame of a at angle 0
  double stiffness = 0;  ///< force per length
  double damping = 0;    ///< force per velocity
  double lower = 0;      ///< rad
  double upper = 0;      ///< rad
  double speed = 0;      ///< rad per unit of time
  double max_force = kNoLimit;
  Place target;
  double break_force = kNoLimit;   ///< the joint breaks if its mean force over a step is larger
  double break_torque = kNoLimit;  ///< the joint breaks if its mean torque over a step is larger

  // Results of a step.
  Vec2 force;         ///< mean force on b over the step
  double torque = 0;  ///< mean torque of the rows that hold the angle, without that of `force` at its lever
  bool is_broken = false;
};

/// True if `joint` is valid for `body_count` bodies: indices and numbers in range, a != b.
bool isValid(const Joint& joint, int body_count);

/// Returns the number of scalar constraints of the joint.
int rowsOf(const Joint& joint);

}  // namespace naiad::physics
