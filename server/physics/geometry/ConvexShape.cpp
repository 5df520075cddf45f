#include "physics/geometry/ConvexShape.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

bool isFinite(double x) {
  return x - x == 0;
}

// Returns the edge's outward normal. It is exact along an axis, because √(x²) is |x|.
Vec2 outward(Vec2 edge) {
  const double by = length(edge);
  return {edge.y / by, -edge.x / by};
}

// Checks the limits common to all shapes, and computes the fields that follow from the vertices.
ShapeStatus finish(ConvexShape& made, ConvexShape& shape) {
  double reach = 0;
  for (int i = 0; i < made.count; ++i) {
    const Vec2 v = made.vertices[at(i)];
    if (!isFinite(v)) return ShapeStatus::kNotFinite;
    if (std::max(std::fabs(v.x), std::fabs(v.y)) > kMaxShapeExtent) return ShapeStatus::kTooLarge;
    reach = std::max(reach, length(v));
  }
  if (reach + made.radius > kMaxShapeExtent) return ShapeStatus::kTooLarge;
  for (int i = 0; i < made.count && made.count > 1; ++i) {
    made.normals[at(i)] = outward(made.vertices[at(following(i, made.count))] - made.vertices[at(i)]);
  }
  made.reach = reach;
  shape = made;
  return ShapeStatus::kOk;
}

ShapeStatus checkRadius(double radius, double least) {
  if (!isFinite(radius)) return ShapeStatus::kNotFinite;
  if (radius < least) return ShapeStatus::kTooSmall;
  return radius > kMaxShapeExtent ? ShapeStatus::kTooLarge : ShapeStatus::kOk;
}

double sizeOf(std::span<const Vec2> points) {
  double size = 0;
  for (const Vec2 p : points) {
    size = std::max({size, std::fabs(p.x - points[0].x), std::fabs(p.y - points[0].y)});
  }
  return size;
}

double signedArea(std::span<const Vec2> points) {
  double twice = 0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    twice += cross(points[i - 1] - points[0], points[i] - points[0]);
  }
  return twice / 2;
}

// Returns the height of b above the line from a to c; positive if it is outward.
double height(Vec2 a, Vec2 b, Vec2 c) {
  return cross(b - a, c - b) / length(c - a);
}

}  // namespace

ShapeStatus makeCircle(double radius, Vec2 centre, ConvexShape& shape) {
  if (const ShapeStatus status = checkRadius(radius, kMinShapeWidth); status != ShapeStatus::kOk)
    return status;
  ConvexShape made;
  made.count = 1;
  made.radius = radius;
  made.vertices[0] = centre;
  return finish(made, shape);
}

ShapeStatus makeCapsule(Vec2 a, Vec2 b, double radius, ConvexShape& shape) {
  if (const ShapeStatus status = checkRadius(radius, kMinShapeWidth); status != ShapeStatus::kOk)
    return status;
  if (!isFinite(a) || !isFinite(b)) return ShapeStatus::kNotFinite;
  if (std::max(std::fabs(b.x - a.x), std::fabs(b.y - a.y)) < kMinShapeWidth) return ShapeStatus::kTooSmall;
  ConvexShape made;
  made.count = 2;
  made.radius = radius;
  made.vertices[0] = a;
  made.vertices[1] = b;
  return finish(made, shape);
}

ShapeStatus makeBox(double half_width, double half_height, Vec2 centre, Rotation rotation, double radius,
                    ConvexShape& shape) {
  const double w = half_width, h = half_height;
  if (!isFinite(w) || !isFinite(h) || !isFinite({rotation.c, rotation.s})) return ShapeStatus::kNotFinite;
  if (w < kMinShapeWidth / 2 || h < kMinShapeWidth / 2) return ShapeStatus::kTooSmall;
  if (w > kMaxShapeExtent || h > kMaxShapeExtent) return ShapeStatus::kTooLarge;
  if (std::fabs(rotation.c * rotation.c + rotation.s * rotation.s - 1) > 1e-9) return ShapeStatus::kNotFinite;
  if (const ShapeStatus status = checkRadius(radius, 0); status != ShapeStatus::kOk) return status;
  ConvexShape made;
  made.count = 4;
  made.radius = radius;
  const std::array<Vec2, 4> corners = {Vec2{-w, -h}, {w, -h}, {w, h}, {-w, h}};
  for (std::size_t i = 0; i < 4; ++i) made.vertices[i] = centre + rotation * corners[i];
  return finish(made, shape);
}

ShapeStatus makePolygon(std::span<const Vec2> points, double radius, ConvexShape& shape) {
  if (points.size() < 3) return ShapeStatus::kTooFew;
  if (points.size() > kMaxVertices) return ShapeStatus::kTooMany;
  if (const ShapeStatus status = checkRadius(radius, 0); status != ShapeStatus::kOk) return status;
  for (const Vec2 p : points) {
    if (!isFinite(p)) return ShapeStatus::kNotFinite;
    if (std::max(std::fabs(p.x), std::fabs(p.y)) > kMaxShapeExtent) return ShapeStatus::kTooLarge;
  }
  const double size = sizeOf(points), area = signedArea(points);
  if (size < kMinShapeWidth ||
      std::fabs(area) < size * std::max(kMinShapeWidth, kMinCornerHeight * size) / 2) {
    return ShapeStatus::kTooSmall;
  }
  if (area < 0) return ShapeStatus::kClockwise;
  // Every point must be strictly on the inner side of every edge. This also rejects self-crossing stars.
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (length(points[(i + 1) % count] - points[i]) < kMinCornerHeight * size) return ShapeStatus::kTooSmall;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 a = points[i], b = points[(i + 1) % count];
    for (std::size_t k = 2; k < count; ++k) {
      if (!(cross(b - a, points[(i + k) % count] - a) > 0)) return ShapeStatus::kNotConvex;
    }
    if (!(height(a, b, points[(i + 2) % count]) > kMinCornerHeight * size)) return ShapeStatus::kNotConvex;
  }
  ConvexShape made;
  made.count = static_cast<std::int32_t>(count);
  made.radius = radius;
  std::copy(points.begin(), points.end(), made.vertices.begin());
  return finish(made, shape);
}

bool isEqual(const ConvexShape& a, const ConvexShape& b) {
  const auto count = static_cast<std::ptrdiff_t>(a.count);
  const auto areEqual = [&](const auto& one, const auto& other) {
    return std::equal(one.begin(), one.begin() + count, other.begin());
  };
  return a.count == b.count && a.radius == b.radius && areEqual(a.vertices, b.vertices) &&
         areEqual(a.normals, b.normals);
}

ConvexShape moved(const ConvexShape& shape, Rotation rotation, Vec2 by) {
  ConvexShape result = shape;
  result.reach = 0;
  for (int i = 0; i < shape.count; ++i) {
    result.vertices[at(i)] = rotation * shape.vertices[at(i)] + by;
    result.normals[at(i)] = rotation * shape.normals[at(i)];
    result.reach = std::max(result.reach, length(result.vertices[at(i)]));
  }
  return result;
}

void turn(const ConvexShape& shape, Rotation rotation, RotatedShape& turned) {
  turned.count = shape.count;
  turned.radius = shape.radius;
  turned.reach = shape.reach;
  for (int i = 0; i < shape.count; ++i) {
    turned.vertices[at(i)] = rotation * shape.vertices[at(i)];
    turned.normals[at(i)] = rotation * shape.normals[at(i)];
  }
}

void turn(const ConvexShape& shape, Rotation rotation, std::span<Vec2> corners) {
  const std::size_t count = at(shape.count);
  for (std::size_t i = 0; i < count; ++i) {
    corners[i] = rotation * shape.vertices[i];
    corners[count + i] = rotation * shape.normals[i];
  }
}

RotatedView rotatedView(const ConvexShape& shape, std::span<const Vec2> corners) {
  return {shape.count, shape.radius, shape.reach, corners.data(), corners.data() + shape.count};
}

Bounds boundsOf(const RotatedView& shape) {
  Bounds bounds = {shape.vertices[0], shape.vertices[0]};
  for (int i = 1; i < shape.count; ++i) {
    const Vec2 v = shape.vertices[at(i)];
    bounds.lower = {std::min(bounds.lower.x, v.x), std::min(bounds.lower.y, v.y)};
    bounds.upper = {std::max(bounds.upper.x, v.x), std::max(bounds.upper.y, v.y)};
  }
  const Vec2 r = {shape.radius, shape.radius};
  return {bounds.lower - r, bounds.upper + r};
}

double thicknessOf(const ConvexShape& shape) {
  if (shape.count < 3) return shape.radius;
  double least = kMaxShapeExtent;
  for (int i = 0; i < shape.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double face = dot(shape.normals[k], shape.vertices[k]);
    double back = face;
    for (int j = 0; j < shape.count; ++j) {
      back = std::min(back, dot(shape.normals[k], shape.vertices[static_cast<std::size_t>(j)]));
    }
    least = std::min(least, 0.5 * (face - back));
  }
  return least + shape.radius;
}

}  // namespace naiad::physics
