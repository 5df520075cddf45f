// The bodies of a RigidWorld, which rotate, push each other, slide and roll.
#pragma once

#include <cmath>

#include "physics/geometry/Place.h"
#include "physics/geometry/Rotation.h"
#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// A body. Time is in ticks, lengths are in metric cells, angles in radians from x to y. Its shapes are
/// passed separately, relative to `place`.
struct RigidBody {
  Place place;  ///< place of the centre of mass
  Vec2 velocity;
  Rotation rotation;
  double spin = 0;             ///< rad per tick
  double inverse_mass = 1;     ///< 0: static, or kinematic if it has a velocity
  double inverse_inertia = 0;  ///< 0: no torque changes its spin
  Vec2 acceleration;           ///< gravity and other forces over mass, as the mean over a step
  Vec2 jerk;                   ///< growth of the acceleration per tick within a step
  double turn_rate = 0;        ///< rad per tick by which a magnet turns its velocity (MagnetTurn.h)
  double torque = 0;           ///< acts in every step until the next set()
  double friction = 0;         ///< >= 0; a pair has the geometric mean of its two
  double restitution = 0;      ///< 0 … 1; a pair has the larger of its two

  friend constexpr bool operator==(const RigidBody& a, const RigidBody& b) = default;
};

/// True if all numbers are in the ranges above and at most 1e30, and the rotation has unit length.
inline bool isValid(const RigidBody& body) {
  const auto isSmall = [](double x) { return std::fabs(x) <= 1e30; };  // false for NaN
  const auto isPart = [&](double x) { return x >= 0 && isSmall(x); };
  const double square = body.rotation.c * body.rotation.c + body.rotation.s * body.rotation.s;
  return std::fabs(body.place.dx) <= 1 && std::fabs(body.place.dy) <= 1 && isSmall(body.velocity.x) &&
         isSmall(body.velocity.y) && std::fabs(square - 1) <= 1e-6 && isSmall(body.spin) &&
         isSmall(body.turn_rate) && isPart(body.inverse_mass) && isPart(body.inverse_inertia) &&
         isSmall(body.acceleration.x) && isSmall(body.acceleration.y) && isSmall(body.jerk.x) &&
         isSmall(body.jerk.y) && isSmall(body.torque) && isPart(body.friction) && body.restitution >= 0 &&
         body.restitution <= 1;
}

constexpr bool isMovable(const RigidBody& body) {
  return body.inverse_mass > 0 || body.inverse_inertia > 0;
}

}  // namespace naiad::physics
