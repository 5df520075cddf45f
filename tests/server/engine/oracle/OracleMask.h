// Masks: the cells that an Object's characters cover, for precise pairs (docs/collisions.md).
#pragma once

#include <string>
#include <vector>

#include "shared/values/Fixed.h"

namespace oracle {

using df::Fixed;
using df::FixedBox;

/// The set characters, one string per row. A blank, or a cell beyond the end of its row, is a hole. Without
/// rows, the whole box is covered.
using Mask = std::vector<std::string>;

/// True if the two masks have set characters in one cell. Boxes are in world coordinates and need not touch.
bool shareCell(const FixedBox& box_a, const Mask& mask_a, const FixedBox& box_b, const Mask& mask_b);

}  // namespace oracle
