// What a body that rotates is made of: convex shapes, with corners that may be rounded.
//
// Every shape is a core of up to 16 points and a radius around it: one point is a circle, two are a capsule,
// more are a polygon. So there is one kind of shape and one algorithm for each question. A compound is
// several shapes whose points are relative to the same body.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "Rotation.h"
#include "Vec2.h"

namespace naiad::physics {

inline constexpr int kMaxVertices = 16;  ///< enough for what looks round; a real circle is a radius
/// Metric cells: a shape is at least this wide and at most this far from its body's origin. Between the two
/// lie 13 of a double's 16 digits.
inline constexpr double kSmallestShape = 1e-6;
inline constexpr double kLargestShape = 1e7;
/// Each corner rises at least this part of the polygon's size above the line between its neighbours.
inline constexpr double kSmallestCorner = 1e-6;

/// Plain data. Points are relative to the body's origin, in its own axes. Made by the functions below, which
/// see to it that it is valid; only the first `count` points and normals mean anything.
struct ConvexShape {
  std::int32_t count = 0;  ///< points of the core, 1 … kMaxVertices
  double radius = 0;       ///< metric cells around the core; > 0 if the core has no area
  double reach = 0;        ///< largest distance of a point of the core from the origin
  std::array<Vec2, kMaxVertices> vertices = {};  ///< in the sense from x to y (positive area)
  std::array<Vec2, kMaxVertices> normals = {};   ///< outward, of the edge from vertex i to the next one
};

enum class ShapeStatus : std::uint8_t {
  kOk,
  kNotFinite,  ///< a NaN or an infinity
  kTooFew,     ///< fewer than three points
  kTooMany,    ///< more than kMaxVertices
  kTooSmall,   ///< no area worth the name, equal points, a radius below zero
  kTooLarge,   ///< beyond kLargestShape
  kNotConvex,  ///< a corner turns in, is flat, or edges cross
  kClockwise,  ///< the points run from y to x
};

/// All of them write `shape` only if they return kOk. `centre` is where it sits on its body.
ShapeStatus makeCircle(double radius, Vec2 centre, ConvexShape& shape);
/// From `a` to `b`, with half discs at both ends.
ShapeStatus makeCapsule(Vec2 a, Vec2 b, double radius, ConvexShape& shape);
/// Half sizes before rounding; the radius goes on top of them.
ShapeStatus makeBox(double half_width, double half_height, Vec2 centre, Rotation rotation, double radius,
                    ConvexShape& shape);
ShapeStatus makePolygon(std::span<const Vec2> points, double radius, ConvexShape& shape);

/// Have they the same points and normals, in the same order, and the same radius?
bool isEqual(const ConvexShape& a, const ConvexShape& b);

/// The same shape elsewhere on its body: turned about the origin, then moved. The caller sees to the limits.
ConvexShape moved(const ConvexShape& shape, Rotation rotation, Vec2 by);

/// A shape in the axes of the world, still relative to the body's origin: what pairs are tested with. Points
/// to what its maker keeps.
struct TurnedView {
  std::int32_t count;
  double radius;
  double reach;
  const Vec2* vertices;
  const Vec2* normals;
};

/// The same with corners of its own. Made once per body and step. Only the first `count` entries are written.
struct TurnedShape {
  std::int32_t count;
  double radius;
  double reach;
  std::array<Vec2, kMaxVertices> vertices;
  std::array<Vec2, kMaxVertices> normals;

  operator TurnedView() const { return {count, radius, reach, vertices.data(), normals.data()}; }
};
void turn(const ConvexShape& shape, Rotation rotation, TurnedShape& turned);
/// Into `corners`, of which there are two for each point: first the points, then the normals.
void turn(const ConvexShape& shape, Rotation rotation, std::span<Vec2> corners);
/// What the latter has made.
TurnedView turnedView(const ConvexShape& shape, std::span<const Vec2> corners);

/// The least half width, rounding included: what passes it by more is on its other side.
double thicknessOf(const ConvexShape& shape);

/// Bounds relative to the body's origin.
struct Bounds {
  Vec2 lower;
  Vec2 upper;
};
Bounds boundsOf(const TurnedView& shape);

constexpr int following(int index, int count) {
  return index + 1 < count ? index + 1 : 0;
}
constexpr int preceding(int index, int count) {
  return index > 0 ? index - 1 : count - 1;
}

}  // namespace naiad::physics
