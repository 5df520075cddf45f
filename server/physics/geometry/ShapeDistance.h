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

/// Distance of the cores of two shapes; subtract both radii to get the gap between the shapes.
struct Separation {
  double distance;  ///< > 0: gap; < 0: overlap, the distance to move along the normal until they are apart
  Vec2 normal;      ///< unit length, from A to B
  Feature feature;
  std::int32_t index_a;  ///< edge of A (by its first vertex) or vertex of A
  std::int32_t index_b;  ///< edge (by its first vertex) or vertex of B
};

/// The edge of a core from which the other core is farthest outside.
struct FaceSeparation {
  double distance = -std::numeric_limits<double>::infinity();
  std::int32_t edge = 0;
  std::int32_t support = 0;  ///< nearest vertex of the other core
};

/// Measures how far `other`, whose origin is `offset` from the shape's, is outside this edge of `shape`. The
/// extents of the shapes are compared before the offset is added, so that equal sizes cancel exactly.
FaceSeparation faceSeparation(const RotatedView& shape, std::int32_t edge, const RotatedView& other,
                              Vec2 offset);
/// Returns the edge with the largest distance, or the first above `enough`; distance −∞ without edges.
FaceSeparation bestFace(const RotatedView& shape, const RotatedView& other, Vec2 offset, double enough);
/// Returns a lower bound of the distance from a circle about `centre` to the shape, by the shape's faces
/// alone; −∞ for a circle or capsule.
double faceGap(const RotatedView& shape, Vec2 centre, double radius);

/// Returns the distance of two cores. `offset` is from A's origin to B's. Exact except for rounding, by
/// separating axes and, if the nearest features are both corners, by the distance between edges that these
/// axes determine. Not iterative. Above `enough`, the result may be any lower bound above it, with its axis.
Separation separation(const RotatedView& a, const RotatedView& b, Vec2 offset,
                      double enough = std::numeric_limits<double>::infinity());

/// Like separation(), with `face_a` and `face_b` already known.
Separation separationFrom(const RotatedView& a, const RotatedView& b, Vec2 offset,
                          const FaceSeparation& face_a, const FaceSeparation& face_b);

}  // namespace naiad::physics
