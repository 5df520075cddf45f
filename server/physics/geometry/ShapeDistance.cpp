#include "physics/geometry/ShapeDistance.h"

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

struct Nearest {
  double squared = std::numeric_limits<double>::infinity();
  Vec2 apart;  // from A to B
  Feature feature = Feature::kVertices;
  std::int32_t index_a = 0;
  std::int32_t index_b = 0;
};

void keepNearer(Nearest& best, const Nearest& other) {
  if (other.squared < best.squared) best = other;
}

// Returns the distance from `point`, vertex `index` of one shape, to an edge of the other one.
Nearest pointToEdge(Vec2 point, std::int32_t index, Vec2 from, Vec2 to, std::int32_t first,
                    std::int32_t second, bool edge_of_a) {
  const Vec2 edge = to - from, out = point - from;
  const double along = dot(out, edge), whole = lengthSquared(edge);
  Nearest found;
  std::int32_t other = first;
  if (along <= 0) {
    found.apart = out;
  } else if (along >= whole) {
    found.apart = point - to, other = second;
  } else {
    const double height = cross(edge, out);
    found.squared = height * height / whole;
    found.apart = {};
    found.feature = edge_of_a ? Feature::kFaceA : Feature::kFaceB;
  }
  if (found.feature == Feature::kVertices) found.squared = lengthSquared(found.apart);
  if (!edge_of_a) found.apart = -found.apart;
  // If the nearest point is on the edge, `other` is the edge's first vertex, by which the edge is named.
  found.index_a = edge_of_a ? other : index;
  found.index_b = edge_of_a ? index : other;
  return found;
}

// Returns the distance between an edge of each shape, by the four ends of the edges.
Nearest betweenEdges(const RotatedView& a, std::int32_t edge_a, const RotatedView& b, std::int32_t edge_b,
                     Vec2 offset) {
  const std::int32_t next_a = following(edge_a, a.count), next_b = following(edge_b, b.count);
  const Vec2 a1 = a.vertices[at(edge_a)], a2 = a.vertices[at(next_a)];
  const Vec2 b1 = offset + b.vertices[at(edge_b)], b2 = offset + b.vertices[at(next_b)];
  Nearest best = pointToEdge(b1, edge_b, a1, a2, edge_a, next_a, true);
  keepNearer(best, pointToEdge(b2, next_b, a1, a2, edge_a, next_a, true));
  keepNearer(best, pointToEdge(a1, edge_a, b1, b2, edge_b, next_b, false));
  keepNearer(best, pointToEdge(a2, next_a, b1, b2, edge_b, next_b, false));
  return best;
}

Separation fromFace(const FaceSeparation& face, const RotatedView& owner, bool of_a) {
  const Vec2 n = owner.normals[at(face.edge)];
  if (of_a) return {face.distance, n, Feature::kFaceA, face.edge, face.support};
  return {face.distance, -n, Feature::kFaceB, face.support, face.edge};
}

// Like faceSeparation(), but tests both sides of a capsule's only edge.
FaceSeparation facing(const RotatedView& shape, std::int32_t edge, const RotatedView& other, Vec2 offset) {
  if (shape.count > 2) return faceSeparation(shape, edge, other, offset);
  return bestFace(shape, other, offset, std::numeric_limits<double>::infinity());
}

Separation fromVertices(Vec2 apart, std::int32_t index_a, std::int32_t index_b) {
  const double distance = length(apart);
  // Equal points have no direction, so a fixed direction is used.
  const Vec2 normal = distance > 0 ? apart / distance : Vec2{0, 1};
  return {distance, normal, Feature::kVertices, index_a, index_b};
}

}  // namespace

namespace {

// Returns the minimum of the corners along a normal. faceSeparation() also finds the corner.
double leastAlong(Vec2 n, const Vec2* p_corners, std::int32_t count) {
  double least = dot(n, p_corners[0]);
  for (std::int32_t j = 1; j < count; ++j) {
    const double s = dot(n, p_corners[j]);
    least = s < least ? s : least;
  }
  return least;
}

}  // namespace

FaceSeparation faceSeparation(const RotatedView& shape, std::int32_t edge, const RotatedView& other,
                              Vec2 offset) {
  const Vec2 n = shape.normals[at(edge)];
  const Vec2* const p_corners = other.vertices;
  const std::int32_t count = other.count;
  double least = dot(n, p_corners[0]);
  std::int32_t support = 0;
  for (std::int32_t j = 1; j < count; ++j) {
    const double s = dot(n, p_corners[j]);
    support = s < least ? j : support;
    least = s < least ? s : least;
  }
  return {dot(n, offset) + (least - dot(n, shape.vertices[at(edge)])), edge, support};
}

FaceSeparation bestFace(const RotatedView& shape, const RotatedView& other, Vec2 offset, double enough) {
  const std::int32_t edges = shape.count;
  if (edges == 1) return {};
  // Finding the corner costs more than finding its distance, so it is done only for the best edge.
  const Vec2 *const p_normals = shape.normals, *const p_vertices = shape.vertices;
  const Vec2* const p_corners = other.vertices;
  const std::int32_t corners = other.count;
  double most = -std::numeric_limits<double>::infinity();
  std::int32_t best = 0;
  for (std::int32_t i = 0; i < edges; ++i) {
    const Vec2 n = p_normals[i];
    const double distance = dot(n, offset) + (leastAlong(n, p_corners, corners) - dot(n, p_vertices[i]));
    if (distance > most) most = distance, best = i;
    if (distance > enough) break;
  }
  if (corners == 1) return {most, best, 0};
  return faceSeparation(shape, best, other, offset);
}

double faceGap(const RotatedView& shape, Vec2 centre, double radius) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::int32_t i = 0; i < shape.count && shape.count > 2; ++i) {
    most = std::max(most, dot(shape.normals[i], centre - shape.vertices[i]) - shape.radius - radius);
  }
  return most;
}

Separation separationFrom(const RotatedView& a, const RotatedView& b, Vec2 offset,
                          const FaceSeparation& face_a, const FaceSeparation& face_b) {
  if (a.count == 1 && b.count == 1) return fromVertices(offset + (b.vertices[0] - a.vertices[0]), 0, 0);
  const bool of_a = face_a.distance >= face_b.distance;
  const FaceSeparation& face = of_a ? face_a : face_b;
  const RotatedView& owner = of_a ? a : b;
  const RotatedView& other = of_a ? b : a;
  const Vec2 to_other = of_a ? offset : -offset;
  // Overlapping polygons have no nearest corners. The cores of two capsules have no area. If these cross, the
  // nearest end of one of them is in front of the best edge.
  const bool flat = a.count <= 2 && b.count <= 2;
  if (face.distance <= 0 && !flat) return fromFace(face, owner, of_a);
  const std::int32_t next = following(face.edge, owner.count);
  const Vec2 first = owner.vertices[at(face.edge)], second = owner.vertices[at(next)];
  const Vec2 out = to_other + (other.vertices[at(face.support)] - first), edge = second - first;
  const double along = dot(out, edge);
  if (along >= 0 && along <= lengthSquared(edge)) return fromFace(face, owner, of_a);

  // The nearest corner of the other shape is not in front of the edge. So the nearest features are two
  // corners, one of the edge and one of the other shape, or two edges that are parallel except for rounding.
  if (other.count == 1) {
    const std::int32_t corner = along < 0 ? face.edge : next;
    const Vec2 apart = of_a ? offset + (b.vertices[0] - a.vertices[at(corner)])
                            : offset + (b.vertices[at(corner)] - a.vertices[0]);
    return fromVertices(apart, of_a ? corner : 0, of_a ? 0 : corner);
  }
  Nearest best;
  for (const std::int32_t beside : {face.support, preceding(face.support, other.count)}) {
    keepNearer(best, of_a ? betweenEdges(a, face.edge, b, beside, offset)
                          : betweenEdges(a, beside, b, face.edge, offset));
  }
  if (best.feature == Feature::kFaceA) return fromFace(facing(a, best.index_a, b, offset), a, true);
  if (best.feature == Feature::kFaceB) return fromFace(facing(b, best.index_b, a, -offset), b, false);
  const Vec2 apart = offset + (b.vertices[at(best.index_b)] - a.vertices[at(best.index_a)]);
  return fromVertices(apart, best.index_a, best.index_b);
}

Separation separation(const RotatedView& a, const RotatedView& b, Vec2 offset, double enough) {
  const FaceSeparation face_a = bestFace(a, b, offset, enough);
  if (face_a.distance > enough) return fromFace(face_a, a, true);
  const FaceSeparation face_b = bestFace(b, a, -offset, enough);
  if (face_b.distance > enough) return fromFace(face_b, b, false);
  return separationFrom(a, b, offset, face_a, face_b);
}

}  // namespace naiad::physics
