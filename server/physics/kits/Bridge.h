// Makes a rope bridge in one line:
//
//   for (df::Body* p_plank : df::makeBridge(left, right, 8)) p_plank->setFriction(1);
#pragma once

#include <vector>

#include "Body.h"

namespace df {

/// Makes planks from `left` to `right` (cells), in this order, each joined by hinges to the next, the outer
/// ones to the world. They lie in a row, may turn, weigh 1 and are 0.9 rows high, with gaps of 0.4 cells. The
/// world owns them; the joints end with them. Returns an empty vector, and makes nothing, for fewer than one
/// plank or if `left` and `right` are too close together for the planks.
std::vector<Body*> makeBridge(Vector left, Vector right, int planks);

}  // namespace df
