// Makes a rope bridge in one line:
//
//   for (df::Body* p_plank : df::makeBridge(left, right, 8)) p_plank->setFriction(1);
#pragma once

#include <vector>

#include "Body.h"

namespace df {

/// Makes planks from `left` to `right` (in cells), in this order. Each is joined to the next by hinges, and
/// the outer ones to the world. The planks lie in a row, may turn, weigh 1 each and are 0.9 rows high, with
/// gaps of 0.4 cells. The world owns them, and the joints end with them. Returns an empty vector and makes
/// nothing if there is less than one plank, or `right` is not far enough to the right of `left` for them.
std::vector<Body*> makeBridge(Vector left, Vector right, int planks);

}  // namespace df
