// The characters of an Object, for pairs that are precise (docs/collisions.md).
#pragma once

#include <string>
#include <vector>

#include "shared/values/Fixed.h"

namespace oracle {

using df::Fixed;
using df::FixedBox;

/// Which characters are set, a string per row: a blank is a hole, and so is what a row is too short for. No
/// rows: all that the box covers.
using Mask = std::vector<std::string>;

/// Do characters of the two, drawn in boxes in world coordinates, share a cell? The boxes need not touch.
bool shareCell(const FixedBox& box_a, const Mask& mask_a, const FixedBox& box_b, const Mask& mask_b);

}  // namespace oracle
