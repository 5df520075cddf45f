// Convex shapes, with corners that may be rounded: the parts of a body that can rotate.
//
// Every shape is a core of up to 16 points and a radius around it. One point makes a circle, two make a
// capsule, and more a polygon, so one algorithm serves all kinds. A compound is several shapes whose points
// are relative to one body.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "Rotation.h"
#include "Vec2.h"

namespace naiad::physics {

inline constexpr int kMaxVertices = 16;  ///< maximum points of a shape: enough for a polygon that looks round
/// Minimum width of a shape (of a circle or capsule: its radius) and maximum distance of its border from the
/// body's origin, in metric cells. Their ratio uses 13 of a double's 16 digits.
inline constexpr double kMinShapeWidth = 1e-6;
inline constexpr double kMaxShapeExtent = 1e7;
/// Minimum height of a corner above the line between its neighbours, and minimum length of an edge, as a
/// fraction of the polygon's size.
inline constexpr double kMinCornerHeight = 1e-6;

/// A shape. Points are relative to the body's origin, in the body's axes. Create shapes only with the
/// functions below, which check them. Entries of `vertices` and `normals` from `count` on are undefined.
struct ConvexShape {
  std::int32_t count = 0;  ///< points of the core, 1 … kMaxVertices
  double radius = 0;       ///< metric cells around the core; > 0 if the core has no area
  double reach = 0;        ///< maximum distance of a core point from the origin
  std::array<Vec2, kMaxVertices> vertices = {};  ///< ordered from x to y, so the area is positive
  std::array<Vec2, kMaxVertices> normals = {};   ///< outward normal of the edge from vertex i to the next
};

enum class ShapeStatus : std::uint8_t {
  kOk,
  kNotFinite,  ///< NaN, infinity, or a rotation whose length is not one
  kTooFew,     ///< fewer than three points
  kTooMany,    ///< more than kMaxVertices points
  kTooSmall,   ///< almost no area or width, equal points, or a negative or too small radius
  kTooLarge,   ///< the border is farther from the origin than kMaxShapeExtent
  kNotConvex,  ///< a corner turns inward or is flat, or edges cross
  kClockwise,  ///< the points are in the wrong order, from y to x
};

/// Makes a circle around a point of the body. The make functions write `shape` only if they return kOk.
ShapeStatus makeCircle(double radius, Vec2 centre, ConvexShape& shape);
/// Makes a capsule from `a` to `b`, with half discs at both ends.
ShapeStatus makeCapsule(Vec2 a, Vec2 b, double radius, ConvexShape& shape);
/// Makes a box. The half sizes do not include `radius`, which is added to them.
ShapeStatus makeBox(double half_width, double half_height, Vec2 centre, Rotation rotation, double radius,
                    ConvexShape& shape);
ShapeStatus makePolygon(std::span<const Vec2> points, double radius, ConvexShape& shape);

/// True if points, normals, their order and the radius are equal.
bool isEqual(const ConvexShape& a, const ConvexShape& b);

/// Returns the shape rotated about the origin, then translated. The caller checks the limits.
ConvexShape moved(const ConvexShape& shape, Rotation rotation, Vec2 by);

/// A shape in world axes, relative to the body's origin, for tests of pairs. Its points are stored elsewhere.
struct RotatedView {
  std::int32_t count;
  double radius;
  double reach;
  const Vec2* vertices;
  const Vec2* normals;
};

/// Like RotatedView, but stores its points; made once per body and step. Only the first `count` are valid.
struct RotatedShape {
  std::int32_t count;
  double radius;
  double reach;
  std::array<Vec2, kMaxVertices> vertices;
  std::array<Vec2, kMaxVertices> normals;

  operator RotatedView() const { return {count, radius, reach, vertices.data(), normals.data()}; }
};
void turn(const ConvexShape& shape, Rotation rotation, RotatedShape& turned);
/// Writes to `corners`, which has two entries per point: first all points, then all normals.
void turn(const ConvexShape& shape, Rotation rotation, std::span<Vec2> corners);
/// Returns a view of the points and normals that turn() wrote to `corners`.
RotatedView rotatedView(const ConvexShape& shape, std::span<const Vec2> corners);

/// Returns half of the minimum width, `radius` included. A body that penetrates deeper exits on the far side.
double thicknessOf(const ConvexShape& shape);

/// A bounding box relative to the body's origin.
struct Bounds {
  Vec2 lower;
  Vec2 upper;
};
Bounds boundsOf(const RotatedView& shape);

constexpr int following(int index, int count) {
  return index + 1 < count ? index + 1 : 0;
}
constexpr int preceding(int index, int count) {
  return index > 0 ? index - 1 : count - 1;
}

}  // namespace naiad::physics
