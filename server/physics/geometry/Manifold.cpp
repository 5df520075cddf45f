#include "physics/geometry/Manifold.h"

#include <algorithm>

#include "physics/geometry/Index.h"
#include "physics/geometry/ShapeDistance.h"

namespace naiad::physics {

namespace {

using Owner = ReferenceFace::Owner;

std::uint32_t idOf(std::int32_t vertex_a, std::int32_t vertex_b) {
  return static_cast<std::uint32_t>(vertex_a) << 8 | static_cast<std::uint32_t>(vertex_b);
}

// Makes a contact with one point, for a corner or a circle.
void onePoint(const RotatedView& a, const RotatedView& b, Vec2 offset, const Separation& s,
              Manifold& manifold) {
  const double gap = s.distance - (a.radius + b.radius);
  manifold.normal = s.normal;
  manifold.count = 1;
  manifold.reference = {};
  ManifoldPoint& point = manifold.points[0];
  point.separation = gap;
  point.id = idOf(s.index_a, s.index_b);
  if (s.feature == Feature::kFaceA) {
    point.anchor_b = b.vertices[at(s.index_b)] - (b.radius + 0.5 * gap) * s.normal;
    point.anchor_a = offset + point.anchor_b;
  } else {
    point.anchor_a = a.vertices[at(s.index_a)] + (a.radius + 0.5 * gap) * s.normal;
    point.anchor_b = point.anchor_a - offset;
  }
}

// One end of the incident edge: its position along the reference edge, distance from that edge, and point.
struct End {
  double along;
  double distance;
  Vec2 core;  // the point, relative to the origin of its body
  std::int32_t owner_vertex;
  std::int32_t other_vertex;
};

End cutAt(double along, const End& near, const End& far) {
  const double part = (along - near.along) / (far.along - near.along);
  return {along, near.distance + part * (far.distance - near.distance),
          near.core + part * (far.core - near.core), near.owner_vertex, near.other_vertex};
}

// Finds the points of the other shape's edge that faces the reference edge. Returns false if it finds none.
bool facePoints(const RotatedView& owner, const RotatedView& other, Vec2 offset, const FaceSeparation& face,
                bool owner_is_a, double speculative, Manifold& manifold) {
  const Vec2 n = owner.normals[at(face.edge)], tangent = perpendicular(n);
  const std::int32_t next = following(face.edge, owner.count), before = preceding(face.support, other.count);
  const Vec2 first = owner.vertices[at(face.edge)], second = owner.vertices[at(next)];
  const bool support_starts = dot(other.normals[at(face.support)], n) <= dot(other.normals[at(before)], n);
  const std::int32_t high = support_starts ? face.support : before;  // the edge runs opposite to the tangent
  const std::int32_t low = following(high, other.count);
  const double start = dot(n, first), begin = dot(tangent, first), end = dot(tangent, second) - begin;
  const auto endAt = [&](std::int32_t vertex, std::int32_t owner_vertex) -> End {
    const Vec2 v = other.vertices[at(vertex)];
    return {dot(tangent, offset) + (dot(tangent, v) - begin), dot(n, offset) + (dot(n, v) - start), v,
            owner_vertex, vertex};
  };
  End lower = endAt(low, face.edge), upper = endAt(high, next);
  const double radii = owner.radius + other.radius;
  const End support = face.support == low ? lower : upper;
  const bool beside = lower.along > end || upper.along < 0;
  if (!beside) {
    const End lower_end = lower;
    if (lower.along < 0 && upper.along > lower.along) lower = cutAt(0, lower, upper);
    if (upper.along > end && upper.along > lower_end.along) upper = cutAt(end, upper, lower_end);
  }
  // Two points at one position become one: the deeper one.
  const bool single = beside || upper.along - lower.along <= 1e-9 * end;
  const End deeper = beside ? support : (upper.distance < lower.distance ? upper : lower);
  manifold.count = 0;
  for (const End& point : {single ? deeper : lower, upper}) {
    const double gap = point.distance - radii;
    if (gap <= speculative) {
      ManifoldPoint& out = manifold.points[at(manifold.count++)];
      const Vec2 on_other = point.core - (other.radius + 0.5 * gap) * n, on_owner = offset + on_other;
      out.anchor_a = owner_is_a ? on_owner : on_other;
      out.anchor_b = owner_is_a ? on_other : on_owner;
      out.separation = gap;
      out.id = owner_is_a ? idOf(point.owner_vertex, point.other_vertex)
                          : idOf(point.other_vertex, point.owner_vertex);
    }
    if (single) break;
  }
  manifold.normal = owner_is_a ? n : -n;
  manifold.reference = {owner_is_a ? Owner::kA : Owner::kB, static_cast<std::uint8_t>(face.edge)};
  return manifold.count > 0;
}

// True if the kept edge is still good enough. Then `face` is that edge's separation.
bool stillGood(const RotatedView& owner, const RotatedView& other, Vec2 offset, std::uint8_t edge,
               double best, FaceSeparation& face) {
  if (edge >= owner.count) return false;
  face = faceSeparation(owner, edge, other, offset);
  if (face.distance < best - kFaceHysteresis * std::min(owner.reach, other.reach)) return false;
  if (face.distance <= 0) return true;
  // If the shapes are apart, a point must be in front of the kept edge.
  const Vec2 first = owner.vertices[at(edge)],
             side = owner.vertices[at(following(edge, owner.count))] - first;
  const double along = dot(offset + (other.vertices[at(face.support)] - first), side);
  return along >= 0 && along <= lengthSquared(side);
}

}  // namespace

bool collide(const RotatedView& a, const RotatedView& b, Vec2 offset, double speculative, ReferenceFace kept,
             Manifold& manifold, bool prefers_faces) {
  const double enough = a.radius + b.radius + speculative;
  manifold.count = 0;
  const FaceSeparation face_a = bestFace(a, b, offset, enough);
  if (face_a.distance > enough) return false;
  const FaceSeparation face_b = bestFace(b, a, -offset, enough);
  if (face_b.distance > enough) return false;
  if (a.count > 1 && b.count > 1 && kept.owner != Owner::kNone) {
    const double best = std::max(face_a.distance, face_b.distance);
    const bool of_a = kept.owner == Owner::kA;
    FaceSeparation face;
    if (of_a ? stillGood(a, b, offset, kept.edge, best, face)
             : stillGood(b, a, -offset, kept.edge, best, face)) {
      return of_a ? facePoints(a, b, offset, face, true, speculative, manifold)
                  : facePoints(b, a, -offset, face, false, speculative, manifold);
    }
  }
  const Separation s = separationFrom(a, b, offset, face_a, face_b);
  if (s.distance > enough) return false;
  if (prefers_faces && s.feature == Feature::kVertices && a.count > 2 && b.count > 2) {
    const bool is_of_a = face_a.distance >= face_b.distance;
    if (is_of_a ? facePoints(a, b, offset, face_a, true, speculative, manifold)
                : facePoints(b, a, -offset, face_b, false, speculative, manifold)) {
      if (manifold.count == 2) return true;
    }
  }
  if (s.feature == Feature::kVertices || a.count == 1 || b.count == 1) {
    onePoint(a, b, offset, s, manifold);
    return true;
  }
  return s.feature == Feature::kFaceA
             ? facePoints(a, b, offset, {s.distance, s.index_a, s.index_b}, true, speculative, manifold)
             : facePoints(b, a, -offset, {s.distance, s.index_b, s.index_a}, false, speculative, manifold);
}

bool collide(const ConvexShape& a, Rotation rotation_a, const ConvexShape& b, Rotation rotation_b,
             Vec2 offset, double speculative, Manifold& manifold) {
  RotatedShape turned_a, turned_b;
  turn(a, rotation_a, turned_a);
  turn(b, rotation_b, turned_b);
  return collide(turned_a, turned_b, offset, speculative, {}, manifold);
}

}  // namespace naiad::physics
