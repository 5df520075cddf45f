// A rope bridge, made in a line:
//
//   for (df::Body* p_plank : df::makeBridge(left, right, 8)) p_plank->setFriction(1);
#pragma once

#include <vector>

#include "Body.h"

namespace df {

/// Planks from `left` to `right` (cells), in this order, each joined by hinges to the next, the outer ones to
/// the world. They lie in a row, may turn, weigh 1 and are 0.9 rows high, with 0.4 cells between them. The
/// world owns them; the joints go with them. Empty, and nothing is made, for fewer than one plank or where
/// the places leave a plank no length.
std::vector<Body*> makeBridge(Vector left, Vector right, int planks);

}  // namespace df
