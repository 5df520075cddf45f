#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/geometry/Mass.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace {

// Returns the mass of a triangle with this area and density 1.
Mass triangle(Vec2 a, Vec2 b, Vec2 c, double area) {
  const Vec2 centre = a + ((b - a) + (c - a)) / 3;
  const double squares = lengthSquared(b - a) + lengthSquared(c - b) + lengthSquared(a - c);
  return {area, centre, area * squares / 36};
}

// Returns the mass of the strip of width `radius` along the outside of an edge.
Mass strip(Vec2 from, Vec2 to, Vec2 normal, double radius) {
  const double edge = length(to - from), area = edge * radius;
  return {area, from + (to - from) / 2 + (radius / 2) * normal, area * (edge * edge + radius * radius) / 12};
}

// Returns the mass of the sector of a disc between two normals, which is at most half a disc.
Mass sector(Vec2 corner, Vec2 from, Vec2 to, double radius) {
  double angle = df::math::atan2(cross(from, to), dot(from, to));
  if (angle < 0) angle = df::math::kPi;  // half a disc: its normals are opposite except for rounding
  if (angle == 0) return {};
  const double half = angle / 2, squared = radius * radius;
  const double away = 2 * radius * df::math::sin(half) / (3 * half);
  // The two normals of half a disc cancel, so the middle is found by rotation, not by their sum.
  const Rotation middle = rotationBy(half);
  const double area = squared * half;
  return {area, corner + away * (middle * from), area * (squared / 2 - away * away)};
}

}  // namespace

Mass massOf(const ConvexShape& shape, double density) {
  const double r = shape.radius;
  const auto vertex = [&](int i) { return shape.vertices[static_cast<std::size_t>(i)]; };
  const auto normal = [&](int i) { return shape.normals[static_cast<std::size_t>(i)]; };
  Mass sum;
  if (shape.count == 1) {
    const double area = df::math::kPi * r * r;
    sum = {area, vertex(0), area * r * r / 2};
  } else {
    for (int i = 2; i < shape.count; ++i) {
      const double area = cross(vertex(i - 1) - vertex(0), vertex(i) - vertex(0)) / 2;
      sum = sum + triangle(vertex(0), vertex(i - 1), vertex(i), area);
    }
    for (int i = 0; i < shape.count && r > 0; ++i) {
      const int next = following(i, shape.count);
      sum = sum + strip(vertex(i), vertex(next), normal(i), r) +
            sector(vertex(next), normal(i), normal(next), r);
    }
  }
  return {sum.mass * density, sum.centre, sum.inertia * density};
}

Mass massOf(std::span<const ConvexShape> shapes, std::span<const double> densities) {
  assert(shapes.size() == densities.size());
  Mass sum;
  for (std::size_t i = 0; i < shapes.size(); ++i) sum = sum + massOf(shapes[i], densities[i]);
  return sum;
}

void recentre(std::span<ConvexShape> shapes, Mass& mass) {
  double reach = 0;
  for (const ConvexShape& shape : shapes) reach = std::max(reach, shape.reach + shape.radius);
  // A centre that differs from zero only by rounding must not change exact points.
  const auto nothing = [&](double x) { return std::fabs(x) <= 1e-15 * reach ? 0.0 : x; };
  const Vec2 by = {nothing(mass.centre.x), nothing(mass.centre.y)};
  for (ConvexShape& shape : shapes) shape = moved(shape, {}, -by);
  mass.centre = {};
}

}  // namespace naiad::physics
