// Turns a body's velocity by a magnet's force within a sub-step, without doing work.
//
// The push is perpendicular to the velocity left by contacts and joints. If something holds the body, they
// remove the push and keep that velocity; rotating it by its angle instead would brake the body. If the body
// is free, the push alone would make it faster: see withoutWork().
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/geometry/Vec2.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

/// Radians in a sub-step. A stronger magnet turns a held body no faster: its force is reduced, and also does
/// no work.
inline constexpr double kMaxMagnetTurn = 1;

/// A velocity, and a magnet's push on it.
struct MagnetTurn {
  Vec2 before;
  Vec2 push;
};

/// `rate` is in radians per tick, from x to y; `h` in ticks.
inline MagnetTurn magnetTurn(Vec2 velocity, double rate, double h) {
  const double angle = std::clamp(rate * h, -kMaxMagnetTurn, kMaxMagnetTurn);
  return {velocity, (df::math::sin(angle) / df::math::cos(angle)) * perpendicular(velocity)};
}

/// Rescales `after`, the velocity after this and all other pushes, so that the magnet does no work. A free
/// body is then turned by exactly the angle. `least` is a part of the push: if less of it is left, something
/// holds the body, and `after` only differs by corrections of joint errors; then it is returned unchanged.
inline Vec2 withoutWork(const MagnetTurn& turn, Vec2 after, double least) {
  const double square = lengthSquared(after), work = dot(turn.push, turn.before + after);
  if (std::fabs(work) <= least * lengthSquared(turn.push)) return after;
  const double wanted = square - work;
  return square > 0 && wanted > 0 ? std::sqrt(wanted / square) * after : after;
}

}  // namespace naiad::physics
