// Which character cells a shape covers, for drawing it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

/// The cells of one row whose centres lie in the shape: they are one after another, for shapes are convex.
struct CellSpan {
  std::int32_t row;
  std::int32_t first;
  std::int32_t last;  ///< included
  friend constexpr bool operator==(const CellSpan& a, const CellSpan& b) = default;
};

/// `centre` is where the body's origin is, in metric cells from the centre of cell (0, 0) of the result: any
/// cell near it that the caller counts from. A cell is 1 wide and `aspect` > 0 high. `spans` is replaced:
/// rows from top to bottom, none of them empty, none left out between two others that are not empty unless
/// the shape is thinner than a cell there. Nothing beyond `furthest` cells is examined.
void rasterise(const TurnedShape& shape, Vec2 centre, double aspect, std::vector<CellSpan>& spans,
               std::int32_t furthest = 4096);

}  // namespace naiad::physics
