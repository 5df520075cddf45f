#include "Solids.h"

#include <algorithm>
#include <limits>

namespace hunt {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distanceToSegment(Vec2 point, Vec2 from, Vec2 to) {
  const Vec2 edge = to - from;
  const double along = dot(point - from, edge) / dot(edge, edge);
  return length(point - from - std::clamp(along, 0.0, 1.0) * edge);
}

Vec2 normalOf(const SolidPart& part, std::size_t edge) {
  const Vec2 along = part.points[(edge + 1) % part.points.size()] - part.points[edge];
  return Vec2{along.y, -along.x} / length(along);
}

// Returns the largest distance of all of `b` from an edge of `a`; below 0 if no edge separates them.
double separation(const SolidPart& a, const SolidPart& b) {
  double most = -kInfinity;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const Vec2 normal = normalOf(a, i);
    double least = kInfinity;
    for (const Vec2 point : b.points) least = std::min(least, dot(point - a.points[i], normal));
    most = std::max(most, least);
  }
  return most;
}

double distanceTo(const SolidPart& polygon, Vec2 point) {
  const double outside = separation(polygon, {{point}, 0});
  if (outside <= 0) return outside;
  double least = kInfinity;
  for (std::size_t i = 0; i < polygon.points.size(); ++i)
    least = std::min(
        least, distanceToSegment(point, polygon.points[i], polygon.points[(i + 1) % polygon.points.size()]));
  return least;
}

double depthOfParts(const SolidPart& a, const SolidPart& b) {
  const double radii = a.radius + b.radius;
  if (a.points.size() == 1 && b.points.size() == 1) return radii - length(a.points[0] - b.points[0]);
  if (a.points.size() == 1) return radii - distanceTo(b, a.points[0]);
  if (b.points.size() == 1) return radii - distanceTo(a, b.points[0]);
  return radii - std::max(separation(a, b), separation(b, a));
}

double halfWidthOf(const SolidPart& part) {
  if (part.points.size() == 1) return part.radius;
  double least = kInfinity;
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    double most = 0;
    for (const Vec2 point : part.points)
      most = std::max(most, -dot(point - part.points[i], normalOf(part, i)));
    least = std::min(least, most);
  }
  return .5 * least + part.radius;
}

}  // namespace

void measure(Solid& solid) {
  solid.reach = 0;
  solid.thickness = kInfinity;
  for (const SolidPart& part : solid.parts) {
    for (const Vec2 point : part.points)
      solid.reach = std::max(solid.reach, length(point - solid.centre) + part.radius);
    solid.thickness = std::min(solid.thickness, halfWidthOf(part));
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
