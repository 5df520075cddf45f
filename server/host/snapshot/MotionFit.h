// Fits a motion in few bits to a path: the published model has to draw the same cells, not to be at the same
// position.
#pragma once

#include <cstdint>
#include <span>

#include "shared/replica/Motion.h"

namespace naiad {

/// A motion on a coarser grid (so it takes fewer bits on the wire) that draws the same cells as `truth` at
/// truth.tick and in each of the `horizon` ticks after it, for a character at each of `offsets` from the
/// position. `truth` itself where nothing coarser does, and for accelerated motions.
///
/// For a velocity v' the positions p' that draw the right cells are those with c(n) − ½ <= p' + n·v' < c(n) +
/// ½ for all n: an interval, of which the number with the fewest bits is taken. Only the n on the convex hull
/// of the c(n) − p − n·v bound it, so the cost is O(horizon) once and little for each of the velocities
/// tried, coarsest first.
Motion fitMotion(const Motion& truth, std::span<const df::FixedVector> offsets, std::uint32_t horizon);

/// Horizons beyond this are not tried: fitMotion() returns `truth`.
inline constexpr std::uint32_t kLongestHorizon = 2048;

}  // namespace naiad
