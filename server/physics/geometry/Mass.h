// Mass, centre and moment of inertia of shapes with constant density, in closed form, and of compounds.
#pragma once

#include <span>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct Mass {
  double mass = 0;
  Vec2 centre;         ///< centre of mass, relative to the body's origin
  double inertia = 0;  ///< moment of inertia about the centre
};

/// Returns the mass of two bodies together. Where their shapes overlap, the overlap counts twice.
constexpr Mass operator+(const Mass& a, const Mass& b) {
  const double mass = a.mass + b.mass;
  if (mass == 0) return {};
  const Vec2 apart = b.centre - a.centre;
  return {mass, a.centre + (b.mass / mass) * apart,
          a.inertia + b.inertia + (a.mass * b.mass / mass) * lengthSquared(apart)};
}

/// Returns the mass of a shape. `density` is mass per metric cell squared; 1 gives the area. The formulas for
/// corners, edges and rounded edges are exact except for floating-point rounding.
Mass massOf(const ConvexShape& shape, double density);

/// Returns the mass of a compound with one density per shape. Overlaps count once for each shape.
Mass massOf(std::span<const ConvexShape> shapes, std::span<const double> densities);

/// Moves the shapes so that the centre of mass becomes the origin, which bodies rotate about.
void recentre(std::span<ConvexShape> shapes, Mass& mass);

}  // namespace naiad::physics
