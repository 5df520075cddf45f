// The motion of an object between two snapshots: the recurrence that server and client share.
//
// At the base tick the object is at `position`; each tick position += velocity, then velocity += acceleration
// (Dragonfly's order). After n ticks that is p + n·w + n(n−1)/2·a, in integers, so the closed form equals
// stepping bit for bit.
#pragma once

#include <cstdint>

#include "shared/values/Fixed.h"

namespace naiad {

/// True if both are drawn in one character cell.
constexpr bool isSameCell(df::FixedVector a, df::FixedVector b) {
  return df::cellOf(a.x) == df::cellOf(b.x) && df::cellOf(a.y) == df::cellOf(b.y);
}

struct Motion {
  std::uint32_t tick = 0;  ///< tick at which `position` and `velocity` hold
  df::FixedVector position;
  df::FixedVector velocity;      ///< actual movement per tick: zero for a blocked object
  df::FixedVector acceleration;  ///< added to the velocity after each move

  friend bool operator==(const Motion&, const Motion&) = default;
};

/// Returns the position at `tick`, which may be before the base tick. Wraps on overflow, because the numbers
/// may come from a hostile server.
df::FixedVector positionAt(const Motion& motion, std::uint32_t tick);

/// Returns an equal motion with its base at `tick`.
Motion rebase(const Motion& motion, std::uint32_t tick);

/// True if the motion changes the position at some tick.
constexpr bool isMoving(const Motion& m) {
  return m.velocity != df::FixedVector{} || m.acceleration != df::FixedVector{};
}

}  // namespace naiad
