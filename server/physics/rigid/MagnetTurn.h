// What turns a body's velocity and does no work: a magnet's force, within a sub-step.
//
// The push is at right angles to the velocity that contacts and joints have left. Where something holds the
// body, they take the push away and leave that velocity; turning it by its angle instead would take it away,
// too, and brake the body. Where nothing does, the push alone would make it faster: withoutWork().
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/geometry/Vec2.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

/// Radians in a sub-step. A stronger magnet turns what is held no faster: its force is smaller, and does as
/// little work.
inline constexpr double kMaxMagnetTurn = 1;

/// A velocity that a magnet pushes by `push`.
struct MagnetTurn {
  Vec2 before;
  Vec2 push;
};

/// `rate`: radians per tick, from x to y; over `h` ticks.
inline MagnetTurn magnetTurn(Vec2 velocity, double rate, double h) {
  const double angle = std::clamp(rate * h, -kMaxMagnetTurn, kMaxMagnetTurn);
  return {velocity, (df::math::sin(angle) / df::math::cos(angle)) * perpendicular(velocity)};
}

/// What the body's velocity became by that push and all others, as fast as these alone make it. A free body
/// has turned by exactly the angle. `least`: a part of the push; if less is left of it, something holds the
/// body, and `after` differs by what undoes the errors of joints.
inline Vec2 withoutWork(const MagnetTurn& turn, Vec2 after, double least) {
  const double square = lengthSquared(after), work = dot(turn.push, turn.before + after);
  if (std::fabs(work) <= least * lengthSquared(turn.push)) return after;
  const double wanted = square - work;
  return square > 0 && wanted > 0 ? std::sqrt(wanted / square) * after : after;
}

}  // namespace naiad::physics
