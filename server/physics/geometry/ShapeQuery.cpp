#include "physics/geometry/ShapeQuery.h"

#include <cmath>
#include <limits>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// Updates `best` if the ray enters the disc earlier. A ray that starts inside and leaves it does not hit.
void enterDisc(Vec2 centre, double radius, Vec2 from, Vec2 displacement, RayHit& best) {
  const double distance = length(displacement);
  const Vec2 along = displacement / distance, out = from - centre;
  const double passes = cross(along, out), inside = (radius - passes) * (radius + passes);
  if (radius == 0 || inside < 0) return;
  const double fraction = (-dot(out, along) - std::sqrt(inside)) / distance;
  if (!(fraction >= 0) || fraction > 1 || (best.hit && fraction >= best.fraction)) return;
  const Vec2 normal = out + fraction * displacement;
  best = {true, fraction, normal / length(normal)};
}

void enterEdge(Vec2 first, Vec2 second, Vec2 normal, Vec2 from, Vec2 displacement, RayHit& best) {
  const double rate = dot(normal, displacement), height = dot(normal, from - first);
  if (rate >= 0 || height < 0) return;
  const double fraction = -height / rate;
  if (fraction > 1 || (best.hit && fraction >= best.fraction)) return;
  // Compares both ends of the edge with the ray itself, so that no ray passes between two edges at a corner.
  if (cross(first - from, displacement) > 0 || cross(second - from, displacement) < 0) return;
  best = {true, fraction, normal};
}

}  // namespace

SurfacePoint closestPoint(const ConvexShape& shape, Vec2 point) {
  double most = -std::numeric_limits<double>::infinity();
  std::int32_t edge = 0;
  for (std::int32_t i = 0; i < shape.count && shape.count > 1; ++i) {
    const double s = dot(shape.normals[at(i)], point - shape.vertices[at(i)]);
    edge = s > most ? i : edge;
    most = s > most ? s : most;
  }
  const Vec2 first = shape.vertices[at(edge)], second = shape.vertices[at(following(edge, shape.count))];
  const Vec2 side = second - first;
  const double along = dot(point - first, side);
  if (shape.count > 1 && ((most < 0 && shape.count > 2) || (along >= 0 && along <= lengthSquared(side)))) {
    const Vec2 normal = shape.normals[at(edge)];
    const double distance = most - shape.radius;
    return {point - distance * normal, normal, distance};
  }
  const Vec2 corner = along < 0 ? first : second, out = point - corner;
  const double away = length(out);
  const Vec2 normal = away > 0 ? out / away : Vec2{0, 1};
  return {corner + shape.radius * normal, normal, away - shape.radius};
}

bool contains(const ConvexShape& shape, Vec2 point) {
  if (shape.count == 1) return lengthSquared(point - shape.vertices[0]) <= shape.radius * shape.radius;
  return closestPoint(shape, point).distance <= 0;
}

RayHit castRay(const ConvexShape& shape, Vec2 from, Vec2 displacement) {
  if (contains(shape, from)) return {true, 0, {}};
  RayHit best;
  for (std::int32_t i = 0; i < shape.count; ++i) {
    enterDisc(shape.vertices[at(i)], shape.radius, from, displacement, best);
    if (shape.count == 1) break;
    const Vec2 normal = shape.normals[at(i)], out = shape.radius * normal;
    enterEdge(shape.vertices[at(i)] + out, shape.vertices[at(following(i, shape.count))] + out, normal, from,
              displacement, best);
  }
  return best;
}

}  // namespace naiad::physics
