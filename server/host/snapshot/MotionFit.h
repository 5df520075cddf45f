// Approximates a motion by one that takes few bits. The published model must draw exactly the right cells,
// but need not be at exactly the right position.
#pragma once

#include <cstdint>
#include <span>

#include "shared/replica/Motion.h"

namespace naiad {

/// Returns a motion on a coarser grid, which takes fewer bits on the wire. For a character at each of
/// `offsets` from the position, it draws the same cells as `truth` at truth.tick and in each of the `horizon`
/// ticks after it. Returns `truth` if no coarser motion that was tried does so, and for motions that are
/// accelerated or exceed 4,096 cells per tick on an axis.
///
/// For a velocity v', the positions p' that draw the right cell c(n) in each tick n are those with
/// c(n) − ½ <= p' + n·v' < c(n) + ½. They are an interval; its number with the fewest bits is used. Only the
/// n on the convex hull of the c(n) − p − n·v limit it, so the cost is O(horizon) once and little for each
/// velocity tried, coarsest first.
Motion fitMotion(const Motion& truth, std::span<const df::FixedVector> offsets, std::uint32_t horizon);

/// Maximum horizon, in ticks. For a longer one, fitMotion() returns `truth`.
inline constexpr std::uint32_t kMaxHorizon = 2048;

}  // namespace naiad
