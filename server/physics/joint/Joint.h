// What joins two bodies: plain data, in the metric of the physics (lengths in metric cells, one unit of time
// is whatever the caller's step is said in, usually the tick).
//
// A joint says one thing; a hinge with limits and a motor is three joints on the same two bodies.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "physics/geometry/Place.h"
#include "physics/geometry/Rotation.h"

namespace naiad::physics {

/// A body as joints see it: no shape. Place, velocity, rotation and spin are read and written by a step.
struct JointBody {
  Place place;  ///< of the centre of mass
  Vec2 velocity;
  Rotation rotation;
  double spin = 0;             ///< rad per unit of time, from x to y
  double inverse_mass = 1;     ///< 0: nothing but its own velocity moves it
  double inverse_inertia = 0;  ///< 0: nothing but its own spin turns it
  Vec2 force;                  ///< beside gravity, constant within the step
  double torque = 0;
};

inline bool isMovable(const JointBody& body) {
  return body.inverse_mass > 0 || body.inverse_inertia > 0;
}

enum class JointKind : std::uint8_t {
  kDistance,    ///< a rod: the anchors stay `length` > 0 apart
  kRope,        ///< the anchors are at most `length` > 0 apart; catching is inelastic
  kHinge,       ///< the anchors coincide
  kWeld,        ///< and the bodies do not turn against each other, either
  kSlider,      ///< b's anchor stays on the line through a's anchor along `axis`; no relative turning
  kSpring,      ///< pulls the anchors to `length` >= 0 with `stiffness`, `damping`
  kMotor,       ///< b turns against a at `speed`, with at most `max_force` as torque
  kAngleLimit,  ///< b's angle against a and `reference` stays in [lower, upper], inside (−π, π)
  kMouse,  ///< a damped spring of length 0 from `target` to b's anchor, with at most `max_force` per axis
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Joint {
  JointKind kind = JointKind::kDistance;
  int a = -1;  ///< index of a body; unused by a mouse
  int b = -1;
  Vec2 anchor_a;  ///< in the frame of a, from its centre
  Vec2 anchor_b;
  double length = 0;
  Vec2 axis = {1, 0};    ///< unit length, in the frame of a
  Rotation reference;    ///< b's rotation in the frame of a when it counts as angle 0
  double stiffness = 0;  ///< force per length
  double damping = 0;    ///< force per velocity
  double lower = 0;      ///< rad
  double upper = 0;      ///< rad
  double speed = 0;      ///< rad per unit of time
  double max_force = kNoLimit;
  Place target;
  double break_force = kNoLimit;   ///< a mean force over a step above this breaks the joint
  double break_torque = kNoLimit;  ///< the same for the torque

  // Written by a step.
  Vec2 force;         ///< what it exerted on b, mean over the step
  double torque = 0;  ///< of the rows that hold the angle; without the lever of `force`
  bool is_broken = false;
  std::array<double, 3> memory =
      {};  ///< the last sub-step's multipliers per its length: the next first guess
};

/// May `joint` be used with `body_count` bodies: indices in range and different, numbers finite and in range?
bool isValid(const Joint& joint, int body_count);
/// Finite, inverse masses in [0, 1e30], everything else below 1e30.
bool isValid(const JointBody& body);

/// How many scalar constraints it adds.
int rowsOf(const Joint& joint);

}  // namespace naiad::physics
