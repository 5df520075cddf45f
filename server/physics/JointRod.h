// Two points on a rod: RATTLE in closed form, for the smallest of all trees (a pendulum, a dumb-bell).
//
// The centre of mass flies exactly; the way from one end to the other goes by RATTLE, whose position equation
// is a quadratic here: a root and a division per stage.
#pragma once

#include <cmath>

#include "Vec2.h"

namespace naiad::physics {

struct JointRod {
  Vec2 offset;            ///< from a to b
  Vec2 velocity;          ///< of b against a
  Vec2 acceleration;      ///< the same, without the rod
  double square = 1;      ///< of the length
  double per_square = 1;  ///< its inverse
  Vec2 pull;              ///< sum of the rod's impulses on b, per reduced mass

  /// Takes the part along the rod out of the velocity.
  void project() { velocity -= (per_square * dot(offset, velocity)) * offset; }

  /// A stage over h != 0, which may be negative, `per_h` its inverse. False if the rod turns too far for it;
  /// nothing has changed then.
  bool advance(double h, double per_h) {
    const Vec2 half_kick = (0.5 * h) * acceleration;
    const Vec2 kicked = velocity + half_kick;
    const Vec2 reached = offset + h * kicked;
    const double half = per_square * dot(reached, offset);
    const double rest = per_square * (lengthSquared(reached) - square);
    const double under_root = half * half - rest;
    if (!(half > 0.5) || !(under_root > 0.01)) return false;
    const double shift = -rest / (half + std::sqrt(under_root));
    const Vec2 first = (shift * per_h) * offset;
    offset = reached + shift * offset;
    const Vec2 free = kicked + first + half_kick;
    const Vec2 second = (per_square * dot(offset, free)) * offset;
    velocity = free - second;
    pull += first - second;
    return true;
  }
};

}  // namespace naiad::physics
