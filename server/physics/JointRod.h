// Two points on a rod: RATTLE in closed form, for the smallest of all trees (a pendulum, a dumb-bell).
//
// The centre of mass flies exactly; the way from one end to the other goes by RATTLE, whose position equation
// is a quadratic here: a root and a division per stage.
#pragma once

#include <cmath>

#include "Vec2.h"

namespace naiad::physics {

struct JointRod {
  Vec2 offset;        ///< from a to b
  Vec2 velocity;      ///< of b against a
  Vec2 acceleration;  ///< the same, without the rod
  double length = 1;
  Vec2 pull;  ///< sum of the rod's impulses on b, per reduced mass

  /// Takes the part along the rod out of the velocity.
  void project() {
    const double along = dot(offset, velocity) / (length * length);
    velocity -= along * offset;
  }

  /// A stage over h != 0, which may be negative. False if the rod turns too far for it; nothing has changed
  /// then.
  bool advance(double h) {
    const Vec2 kicked = velocity + (0.5 * h) * acceleration;
    const Vec2 reached = offset + h * kicked;
    const double square = length * length;
    const double half = dot(reached, offset) / square;
    const double rest = (lengthSquared(reached) - square) / square;
    const double root_of = half * half - rest;
    if (!(half > 0.5) || !(root_of > 0.01)) return false;
    const double shift = -rest / (half + std::sqrt(root_of));
    const Vec2 first = (shift / h) * offset;
    offset = reached + shift * offset;
    velocity = kicked + first + (0.5 * h) * acceleration;
    const Vec2 second = (dot(offset, velocity) / square) * offset;
    velocity -= second;
    pull += first - second;
    return true;
  }
};

}  // namespace naiad::physics
