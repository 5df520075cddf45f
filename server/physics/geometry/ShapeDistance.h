// How far apart two convex shapes are, and along which line: what manifolds and times of impact rest upon.
#pragma once

#include <limits>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

enum class Feature : std::uint8_t {
  kFaceA,     ///< an edge of A, a vertex of B
  kFaceB,     ///< an edge of B, a vertex of A
  kVertices,  ///< a vertex of each
};

/// Between the cores; take both radii off for the gap between the shapes.
struct Separation {
  double distance;  ///< > 0: apart, by so much; < 0: to be moved so far along the normal to come apart
  Vec2 normal;      ///< of length one, from A to B
  Feature feature;
  std::int32_t index_a;  ///< the edge (named after its first vertex) or the vertex of A
  std::int32_t index_b;  ///< likewise of B
};

/// The best edge of one core: the one that the other core is farthest outside of.
struct FaceSeparation {
  double distance = -std::numeric_limits<double>::infinity();
  std::int32_t edge = 0;
  std::int32_t support = 0;  ///< the nearest vertex of the other
};

/// One edge of `shape` against all of `other`, whose origin is `offset` from the shape's. The supports are
/// compared before the offset between the bodies is added, so that equal sizes cancel exactly.
FaceSeparation faceSeparation(const TurnedView& shape, std::int32_t edge, const TurnedView& other,
                              Vec2 offset);
/// The best one; ends early with one beyond `enough`. Nothing (−∞) for a shape without edges.
FaceSeparation bestFace(const TurnedView& shape, const TurnedView& other, Vec2 offset, double enough);
/// How far a circle about `centre` is from the shape at least, by the shape's faces alone: nothing (−∞) where
/// it has none.
double faceGap(const TurnedView& shape, Vec2 centre, double radius);

/// `offset`: from A's origin to B's. Exact but for rounding, by separating axes and, where the nearest
/// features are both corners, by the distance between edges that these axes single out. No iteration. Once it
/// is clear that the distance exceeds `enough` the result may be any lower bound above it, with its axis.
Separation separation(const TurnedView& a, const TurnedView& b, Vec2 offset,
                      double enough = std::numeric_limits<double>::infinity());

/// The same with `face_a` and `face_b` already known.
Separation separationFrom(const TurnedView& a, const TurnedView& b, Vec2 offset, const FaceSeparation& face_a,
                          const FaceSeparation& face_b);

}  // namespace naiad::physics
