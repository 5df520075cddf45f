#include "Solids.h"

#include <algorithm>
#include <limits>

namespace hunt {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the least distance of points from the line of an edge, outwards.
double leastDistance(const SolidPart& part, std::size_t edge, const std::vector<Vec2>& points) {
  const Vec2 along = part.points[(edge + 1) % part.points.size()] - part.points[edge];
  const Vec2 normal = Vec2{along.y, -along.x} / length(along);
  double least = kInfinity;
  for (const Vec2 point : points) least = std::min(least, dot(point - part.points[edge], normal));
  return least;
}

// Returns the largest distance of all of `b` from an edge of `a`; below 0 if no edge separates them.
double separation(const SolidPart& a, const SolidPart& b) {
  double most = -kInfinity;
  for (std::size_t i = 0; i < a.points.size(); ++i) most = std::max(most, leastDistance(a, i, b.points));
  return most;
}

double distanceTo(const SolidPart& polygon, Vec2 point) {
  const double outside = separation(polygon, {{point}, 0});
  if (outside <= 0) return outside;
  double least = kInfinity;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const Vec2 from = point - polygon.points[i];
    const Vec2 edge = polygon.points[(i + 1) % polygon.points.size()] - polygon.points[i];
    least = std::min(least, length(from - std::clamp(dot(from, edge) / dot(edge, edge), 0.0, 1.0) * edge));
  }
  return least;
}

double depthOfParts(const SolidPart& a, const SolidPart& b) {
  const double radii = a.radius + b.radius;
  if (a.points.size() == 1 && b.points.size() == 1) return radii - length(a.points[0] - b.points[0]);
  if (a.points.size() == 1) return radii - distanceTo(b, a.points[0]);
  if (b.points.size() == 1) return radii - distanceTo(a, b.points[0]);
  return radii - std::max(separation(a, b), separation(b, a));
}

}  // namespace

void measure(Solid& solid) {
  solid.reach = 0;
  solid.thickness = kInfinity;
  for (const SolidPart& part : solid.parts) {
    double width = part.points.size() == 1 ? 0 : kInfinity;
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      solid.reach = std::max(solid.reach, length(part.points[i] - solid.centre) + part.radius);
      if (width > 0) width = std::min(width, std::max(0.0, -leastDistance(part, i, part.points)));
    }
    solid.thickness = std::min(solid.thickness, .5 * width + part.radius);
  }
}

double depthOf(const Solid& a, const Solid& b) {
  const double apart = length(a.centre - b.centre) - a.reach - b.reach;
  if (apart > 1) return -apart;
  double deepest = -kInfinity;
  for (const SolidPart& one : a.parts) {
    for (const SolidPart& other : b.parts) deepest = std::max(deepest, depthOfParts(one, other));
  }
  return deepest;
}

}  // namespace hunt
