// Finds the character cells that a shape covers, for drawing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// The cells of one row whose centres lie in the shape, contiguous because shapes are convex.
struct CellSpan {
  std::int32_t row;
  std::int32_t first;
  std::int32_t last;  ///< inclusive
  friend constexpr bool operator==(const CellSpan& a, const CellSpan& b) = default;
};

/// Finds the cells whose centres lie in a shape. A cell is 1 wide and `aspect` > 0 high. `centre` is the
/// body's origin in these units, from the centre of cell (0, 0); the caller may choose any cell near the body
/// as (0, 0). Replaces `spans` by the non-empty rows from top to bottom. A row between two others can be
/// missing only where the shape is thinner than a cell. Rows and columns beyond ±`furthest` are omitted.
void rasterise(const RotatedShape& shape, Vec2 centre, double aspect, std::vector<CellSpan>& spans,
               std::int32_t furthest = 4096);

}  // namespace naiad::physics
