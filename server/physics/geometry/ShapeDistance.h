// Distance of two convex shapes and its direction: the base of manifolds and times of impact.
#pragma once

#include <limits>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

enum class Feature : std::uint8_t {
  kFaceA,     ///< an edge of A, a vertex of B
  kFaceB,     ///< an edge of B, a vertex of A
  kVertices,  ///< a vertex of each
};

/// Distance of the cores; subtract both radii for the gap between the shapes.
struct Separation {
  double distance;  ///< > 0: gap; < 0: distance to move along the normal until they are apart
  Vec2 normal;      ///< unit length, from A to B
  Feature feature;
  std::int32_t index_a;  ///< edge of A (by its first vertex) or vertex of A
  std::int32_t index_b;  ///< edge or vertex of B
};

/// The edge of one core that the other core is farthest outside of.
struct FaceSeparation {
  double distance = -std::numeric_limits<double>::infinity();
  std::int32_t edge = 0;
  std::int32_t support = 0;  ///< nearest vertex of the other core
};

/// Compares one edge of `shape` with all of `other`, whose origin is `offset` from the shape's. The supports
/// are compared before the bodies' offset is added, so that equal sizes cancel exactly.
FaceSeparation faceSeparation(const RotatedView& shape, std::int32_t edge, const RotatedView& other,
                              Vec2 offset);
/// Returns the best edge, or the first found with more than `enough`. −∞ for a shape without edges.
FaceSeparation bestFace(const RotatedView& shape, const RotatedView& other, Vec2 offset, double enough);
/// Returns a lower bound of the distance of a circle about `centre` to the shape, by the shape's faces alone;
/// −∞ for a shape without faces.
double faceGap(const RotatedView& shape, Vec2 centre, double radius);

/// `offset` is from A's origin to B's. Exact but for rounding, by separating axes and, if the nearest
/// features are both corners, by the distance between edges that these axes determine. Not iterative. If the
/// distance exceeds `enough`, the result may be any lower bound above it, with its axis.
Separation separation(const RotatedView& a, const RotatedView& b, Vec2 offset,
                      double enough = std::numeric_limits<double>::infinity());

/// Like separation(), with `face_a` and `face_b` already known.
Separation separationFrom(const RotatedView& a, const RotatedView& b, Vec2 offset,
                          const FaceSeparation& face_a, const FaceSeparation& face_b);

}  // namespace naiad::physics
