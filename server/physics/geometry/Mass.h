// Mass, centre and moment of inertia: of a shape of even density, in closed form, and of several together.
#pragma once

#include <span>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct Mass {
  double mass = 0;
  Vec2 centre;         ///< of mass, relative to the body's origin
  double inertia = 0;  ///< about the centre
};

/// Of both together. Where shapes overlap, the overlap counts twice.
constexpr Mass operator+(const Mass& a, const Mass& b) {
  const double mass = a.mass + b.mass;
  if (mass == 0) return {};
  const Vec2 apart = b.centre - a.centre;
  return {mass, a.centre + (b.mass / mass) * apart,
          a.inertia + b.inertia + (a.mass * b.mass / mass) * lengthSquared(apart)};
}

/// Mass per metric cell squared; 1 gives the area. Exact formulas for corners, edges and rounding alike; what
/// remains is rounding.
Mass massOf(const ConvexShape& shape, double density);

/// Of a compound: one density per shape. Overlaps count as often as they are covered.
Mass massOf(std::span<const ConvexShape> shapes, std::span<const double> densities);

/// Moves the shapes so that the centre of mass becomes the origin, about which bodies turn.
void recentre(std::span<ConvexShape> shapes, Mass& mass);

}  // namespace naiad::physics
