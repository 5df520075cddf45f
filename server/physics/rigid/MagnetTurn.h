// Turns a body's velocity by a magnet's force within a sub-step, without doing work.
//
// The push is perpendicular to the velocity that remains after contacts and joints. If something holds the
// body, contacts and joints cancel the push and keep that velocity; to rotate it by its angle instead would
// brake the body. If the body is free, the push alone would make it faster, which withoutWork() corrects.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/geometry/Vec2.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

/// Maximum rotation in a sub-step, in radians. A stronger magnet has a weaker force on a held body, which
/// does no work either.
inline constexpr double kMaxMagnetTurn = 1;

/// A velocity, and a magnet's push on it.
struct MagnetTurn {
  Vec2 before;
  Vec2 push;
};

/// Returns a magnet's push. `rate` is in radians per tick, from x to y; `h` is in ticks.
inline MagnetTurn magnetTurn(Vec2 velocity, double rate, double h) {
  const double angle = std::clamp(rate * h, -kMaxMagnetTurn, kMaxMagnetTurn);
  return {velocity, (df::math::sin(angle) / df::math::cos(angle)) * perpendicular(velocity)};
}

/// Rescales `after`, the velocity after this and all other pushes, so that the magnet does no work. The
/// velocity of a free body is then rotated by exactly the angle. `least` is a part of the push. If less than
/// this part remains, something holds the body, and `after` differs only by corrections of joint errors; then
/// it is returned unchanged.
inline Vec2 withoutWork(const MagnetTurn& turn, Vec2 after, double least) {
  const double square = lengthSquared(after), work = dot(turn.push, turn.before + after);
  if (std::fabs(work) <= least * lengthSquared(turn.push)) return after;
  const double wanted = square - work;
  return square > 0 && wanted > 0 ? std::sqrt(wanted / square) * after : after;
}

}  // namespace naiad::physics
