// How an object moves between two snapshots: the one recurrence that server and client share.
//
// At the base tick the object is at `position`; each tick position += velocity, then velocity +=
// acceleration (the book's order). After n ticks that is p + n·w + n(n−1)/2·a, in integers, so evaluating
// the closed form equals stepping bit for bit and no end needs to step.
#pragma once

#include <cstdint>

#include "shared/values/Fixed.h"

namespace naiad {

/// Are both drawn in the same character cell?
constexpr bool isSameCell(df::FixedVector a, df::FixedVector b) {
  return df::cellOf(a.x) == df::cellOf(b.x) && df::cellOf(a.y) == df::cellOf(b.y);
}

struct Motion {
  std::uint32_t tick = 0;  ///< the tick at which `position` and `velocity` hold
  df::FixedVector position;
  df::FixedVector velocity;      ///< what it really does per tick: zero for a blocked object
  df::FixedVector acceleration;  ///< added to the velocity after each move

  friend bool operator==(const Motion&, const Motion&) = default;
};

/// The position at `tick` (which may lie before the base). Wraps on overflow instead of trapping: the
/// numbers may come from a hostile server.
df::FixedVector positionAt(const Motion& motion, std::uint32_t tick);

/// The same motion with its base at `tick`: position and velocity are what they will be then.
Motion rebase(const Motion& motion, std::uint32_t tick);

/// Does the motion ever change position?
constexpr bool isMoving(const Motion& m) {
  return m.velocity != df::FixedVector{} || m.acceleration != df::FixedVector{};
}

}  // namespace naiad
