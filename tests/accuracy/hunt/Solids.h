// Shapes in the world, and how deep they overlap. Shares no code with the product.
#pragma once

#include <vector>

#include "HuntScene.h"

namespace hunt {

/// A circle (one point) or a convex polygon in world coordinates.
struct SolidPart {
  std::vector<Vec2> points;  ///< ordered from x to y
  double radius = 0;
};

struct Solid {
  std::vector<SolidPart> parts;
  Vec2 centre;
  double reach = 0;      ///< the largest distance of a point from the centre
  double thickness = 0;  ///< half the least width of its parts
};

/// Sets reach and thickness from the parts.
void measure(Solid& solid);
/// Returns how deep two solids overlap; below 0 it is minus a lower bound of their distance.
double depthOf(const Solid& a, const Solid& b);

}  // namespace hunt
