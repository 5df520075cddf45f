#include "physics/geometry/ShapeRaster.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// The ends of the part of a horizontal line that is inside a shape. The border consists of straight lines and
// of arcs of discs inside the shape, so the outermost crossings with these lines and discs are the ends.
struct Crossing {
  double from = 1;
  double to = 0;
  void add(double x) {
    if (from > to) {
      from = to = x;
      return;
    }
    from = std::min(from, x);
    to = std::max(to, x);
  }
};

Crossing crossingOf(const RotatedShape& shape, double y) {
  Crossing crossing;
  for (std::int32_t i = 0; i < shape.count; ++i) {
    const Vec2 corner = shape.vertices[at(i)];
    const double high = y - corner.y, inside = (shape.radius - high) * (shape.radius + high);
    if (inside >= 0) {
      crossing.add(corner.x - std::sqrt(inside));
      crossing.add(corner.x + std::sqrt(inside));
    }
    if (shape.count == 1) break;
    const Vec2 out = shape.radius * shape.normals[at(i)];
    const Vec2 a = corner + out, b = shape.vertices[at(following(i, shape.count))] + out;
    if ((y < a.y && y < b.y) || (y > a.y && y > b.y)) continue;
    if (a.y == b.y) {
      crossing.add(a.x);
      crossing.add(b.x);
    } else {
      crossing.add(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  return crossing;
}

}  // namespace

void rasterise(const RotatedShape& shape, Vec2 centre, double aspect, std::vector<CellSpan>& spans,
               std::int32_t furthest) {
  spans.clear();
  const double most = furthest;
  const auto cell = [&](double x) { return static_cast<std::int32_t>(std::clamp(x, -most - 1, most + 1)); };
  const Bounds bounds = boundsOf(shape);
  const std::int32_t top = std::max(cell(std::ceil((centre.y + bounds.lower.y) / aspect)), -furthest);
  const std::int32_t bottom = std::min(cell(std::floor((centre.y + bounds.upper.y) / aspect)), furthest);
  for (std::int32_t row = top; row <= bottom; ++row) {
    const Crossing crossing = crossingOf(shape, row * aspect - centre.y);
    if (crossing.from > crossing.to) continue;
    const std::int32_t first = std::max(cell(std::ceil(centre.x + crossing.from)), -furthest);
    const std::int32_t last = std::min(cell(std::floor(centre.x + crossing.to)), furthest);
    if (first <= last) spans.push_back({row, first, last});
  }
}

}  // namespace naiad::physics
