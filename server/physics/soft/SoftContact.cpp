#include "physics/soft/SoftContact.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"
#include "physics/geometry/ShapeQuery.h"

namespace naiad::physics {

namespace {

// A node's path relative to an obstacle, in the obstacle's axes.
struct LocalPath {
  Vec2 from;
  Vec2 displacement;
};
LocalPath localPath(const SoftBody& body, Vec2 from, Vec2 to, const SoftPose& rigid, double h) {
  const Vec2 origin = rigid.place - body.place;
  const Vec2 start = inverse(rigid.rotation) * (from - origin);
  const Rotation later = turned(rigid.rotation, h * rigid.spin);
  return {start, inverse(later) * (to - (origin + h * rigid.velocity)) - start};
}

std::uint64_t keyOf(int body, int feature, int other, int other_feature) {
  static_assert(2 * kMaxSoftNodes < 32771);  // features are nodes, and the lines between them
  return ((static_cast<std::uint64_t>(body) * 32771 + static_cast<std::uint64_t>(feature)) << 32) ^
         (static_cast<std::uint64_t>(other) * 8209 + static_cast<std::uint64_t>(other_feature));
}

int segmentsOf(const SoftBody& body) {
  const int count = static_cast<int>(body.boundary.size());
  return body.is_closed ? count : count - 1;
}
int firstOf(const SoftBody& body, int segment) {
  return body.boundary[at(segment)];
}
int secondOf(const SoftBody& body, int segment) {
  return body.boundary[at(following(segment, static_cast<int>(body.boundary.size())))];
}

SoftRow rowAgainst(const SoftPose& rigid, const SoftBody& body, Vec2 point, Vec2 normal) {
  SoftRow row;
  row.obstacle = rigid.index;
  row.lever = point - (rigid.place - body.place);
  row.axes[0] = normal;
  row.axes[1] = perpendicular(normal);
  row.friction = std::sqrt(body.friction * rigid.obstacle->friction);
  return row;
}

// Appends a row for the plane that keeps a node out of a shape, if the node may be near it in the sub-step.
void findNode(const SoftView& soft, int node, const SoftPose& rigid, int shape_index, double h,
              std::vector<SoftRow>& rows) {
  const SoftBody& body = *soft.body;
  const ConvexShape& shape = rigid.obstacle->shapes[at(shape_index)];
  const LocalPath local = localPath(body, body.nodes[at(node)].offset, soft.ends[node], rigid, h);
  const double skin = kSoftSkin * body.radius, travel = length(local.displacement);
  const SurfacePoint near = closestPoint(shape, local.from);
  double gap = near.distance - body.radius;
  Vec2 normal = near.normal;
  if (gap > travel + skin || gap + dot(normal, local.displacement) > skin) return;
  if (gap > body.radius) {  // the node starts farther away than its radius: find the point that it would hit
    ConvexShape thick = shape;
    thick.radius += body.radius;
    const RayHit hit = castRay(thick, local.from, local.displacement);
    if (!hit.hit) return;
    normal = hit.normal;
    gap = -dot(normal, local.displacement) * hit.fraction;
  }
  const Vec2 out = rigid.rotation * normal;
  SoftRow row = rowAgainst(rigid, body, body.nodes[at(node)].offset - (gap + body.radius) * out, out);
  row.a = {soft.id, {node, -1}, {1, 0}};
  row.gaps[0] = gap;
  row.key = keyOf(soft.id, node, rigid.obstacle->id, shape_index + 1);
  rows.push_back(row);
}

// Appends rows for corners of the shape that may touch the line between two nodes.
void findCorners(const SoftView& soft, int segment, const SoftPose& rigid, int shape_index, double h,
                 std::vector<SoftRow>& rows) {
  const SoftBody& body = *soft.body;
  const ConvexShape& shape = rigid.obstacle->shapes[at(shape_index)];
  const int nodes[] = {firstOf(body, segment), secondOf(body, segment)};
  const Vec2 first = body.nodes[at(nodes[0])].offset, along = body.nodes[at(nodes[1])].offset - first;
  const double far = length(along);
  if (!(far > 1e-9)) return;
  const Vec2 origin = rigid.place - body.place;
  Vec2 middle;
  for (int i = 0; i < shape.count; ++i) middle += shape.vertices[at(i)] / shape.count;
  middle = rigid.rotation * middle;
  const double side = cross(along, origin + middle - first);
  const Vec2 out = (side > 0 ? -1 : 1) * perpendicular(along) / far;  // direction away from the obstacle
  for (int i = 0; i < shape.count; ++i) {
    const Vec2 lever = rigid.rotation * shape.vertices[at(i)], corner = origin + lever - first;
    const double t = dot(corner, along) / (far * far);
    if (!(t > 0.02 && t < 0.98)) continue;
    const double gap = -dot(corner, out) - body.radius - shape.radius;
    const Vec2 goes = (1 - t) * (soft.ends[nodes[0]] - first) +
                      t * (soft.ends[nodes[1]] - body.nodes[at(nodes[1])].offset) -
                      h * (rigid.velocity + cross(rigid.spin, lever));
    const double later = gap + dot(goes, out), skin = kSoftSkin * body.radius;
    if (std::min(gap, later) > skin || gap < -body.radius - 0.5 * far) continue;
    SoftRow row = rowAgainst(rigid, body, origin + lever + shape.radius * out, out);
    row.a = {soft.id, {nodes[0], nodes[1]}, {1 - t, t}};
    row.gaps[0] = gap;
    row.key = keyOf(soft.id, kMaxSoftNodes + segment, rigid.obstacle->id, 32 * (shape_index + 1) + i);
    rows.push_back(row);
  }
}

struct Nearest {
  int segment = -1;
  double part = 0;      // part of the segment's length
  double distance = 0;  // distance of the surface; negative inside
  Vec2 normal;
};

// Finds the nearest point of the boundary. `point` is inside if its ray crosses an odd number of lines.
Nearest nearestOn(const SoftBody& body, Vec2 point) {
  Nearest best;
  double least = 1e300;
  bool is_inside = false;
  Vec2 nearest, side;
  for (int k = 0; k < segmentsOf(body); ++k) {
    const Vec2 a = body.nodes[at(firstOf(body, k))].offset, b = body.nodes[at(secondOf(body, k))].offset;
    const Vec2 along = b - a;
    const double square = lengthSquared(along);
    const double t = square > 0 ? std::clamp(dot(point - a, along) / square, 0.0, 1.0) : 0;
    const Vec2 there = a + t * along;
    const double away = lengthSquared(point - there);
    if (away < least) {
      least = away;
      best.segment = k;
      best.part = t;
      nearest = there;
      side = along;
    }
    if ((a.y > point.y) != (b.y > point.y)) {
      const double ahead = cross(b - a, point - a);
      is_inside ^= (b.y > a.y) == (ahead > 0);
    }
  }
  if (best.segment < 0) return best;
  is_inside = is_inside && body.is_closed;
  const double far = std::sqrt(least), long_side = length(side);
  best.distance = is_inside ? -far : far;
  if (is_inside && long_side > 0) {
    best.normal = -perpendicular(side) / long_side;
  } else {
    best.normal = far > 0 ? (point - nearest) / far : Vec2{0, -1};
  }
  return best;
}

bool overlap(Vec2 lower, Vec2 upper, Vec2 other_lower, Vec2 other_upper) {
  return lower.x <= other_upper.x && lower.y <= other_upper.y && other_lower.x <= upper.x &&
         other_lower.y <= upper.y;
}

}  // namespace

bool isValid(const SoftObstacle& obstacle) {
  const auto isFine = [&](Vec2 v) { return isSmallSoft(v.x) && isSmallSoft(v.y); };
  const double square = lengthSquared({obstacle.rotation.c, obstacle.rotation.s});
  return isFine(obstacle.velocity) && isSmallSoft(obstacle.spin) && isFine(obstacle.acceleration) &&
         obstacle.inverse_mass >= 0 && isSmallSoft(obstacle.inverse_mass) && obstacle.inverse_inertia >= 0 &&
         isSmallSoft(obstacle.inverse_inertia) && obstacle.friction >= 0 && isSmallSoft(obstacle.friction) &&
         std::fabs(obstacle.place.dx) <= 1 && std::fabs(obstacle.place.dy) <= 1 &&
         std::fabs(square - 1) < 1e-6;
}

void findContacts(const SoftView& soft, const SoftPose& rigid, double h, std::vector<SoftRow>& rows) {
  const Vec2 origin = rigid.place - soft.body->place, moves = h * rigid.velocity;
  const Vec2 reach = {rigid.reach + std::fabs(moves.x), rigid.reach + std::fabs(moves.y)};
  const Vec2 lower = origin - reach, upper = origin + reach;
  if (!overlap(soft.lower, soft.upper, lower, upper)) return;
  const SoftBody& body = *soft.body;
  const double thick = (1 + kSoftSkin) * body.radius;
  const auto isNear = [&](int a, int b) {
    const Vec2 points[] = {body.nodes[at(a)].offset, soft.ends[a], body.nodes[at(b)].offset, soft.ends[b]};
    Vec2 least = points[0], most = points[0];
    for (const Vec2 p : points) {
      least = {std::min(least.x, p.x), std::min(least.y, p.y)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    }
    return overlap(least - Vec2{thick, thick}, most + Vec2{thick, thick}, lower, upper);
  };
  const int shapes = static_cast<int>(rigid.obstacle->shapes.size());
  for (std::size_t i = 0; i < soft.patches.size(); ++i) {
    if (!mayMeet(soft.patches[i], body, rigid, h)) continue;
    const int begin = static_cast<int>(i) * kSoftPatch, nodes = static_cast<int>(body.nodes.size());
    for (int node = begin; node < std::min(begin + kSoftPatch, nodes); ++node) {
      for (int k = 0; k < shapes && isNear(node, node); ++k) findNode(soft, node, rigid, k, h, rows);
    }
  }
  for (int k = 0; k < shapes; ++k) {
    for (const int node : body.boundary) {
      if (soft.patches.empty() && isNear(node, node)) findNode(soft, node, rigid, k, h, rows);
    }
    for (int s = 0; s < segmentsOf(body); ++s) {
      if (isNear(firstOf(body, s), secondOf(body, s))) findCorners(soft, s, rigid, k, h, rows);
    }
  }
}

double lastingDepth(const SoftRow& row, double radius) {
  constexpr double kRecovery = 0.2, kMaxRecovery = 0.02;
  const double depth = std::max(0.0, -row.gaps[0]);
  return depth - std::min(kRecovery * depth, kMaxRecovery * radius);
}

void appendPatches(std::span<const SoftNode> starts, const Vec2* ends, double thick,
                   std::vector<SoftPatch>& patches) {
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Vec2 start = starts[i].offset, end = ends[i];
    if (i % kSoftPatch == 0) patches.push_back({{1e300, 1e300}, {-1e300, -1e300}});
    SoftPatch& patch = patches.back();
    patch.lower = {std::min({patch.lower.x, start.x - thick, end.x - thick}),
                   std::min({patch.lower.y, start.y - thick, end.y - thick})};
    patch.upper = {std::max({patch.upper.x, start.x + thick, end.x + thick}),
                   std::max({patch.upper.y, start.y + thick, end.y + thick})};
  }
}

bool mayMeet(const SoftPatch& patch, const SoftBody& body, const SoftPose& rigid, double h) {
  const Vec2 middle = 0.5 * (patch.lower + patch.upper);
  const double goes = h * (length(rigid.velocity) + std::fabs(rigid.spin) * rigid.reach);
  const double room = 0.5 * length(patch.upper - patch.lower) + goes;
  const Vec2 there = inverse(rigid.rotation) * (middle - (rigid.place - body.place));
  const auto isNear = [&](const ConvexShape& shape) { return closestPoint(shape, there).distance <= room; };
  return std::any_of(rigid.obstacle->shapes.begin(), rigid.obstacle->shapes.end(), isNear);
}

bool mayMeet(const SoftView& a, const SoftView& b) {
  const Vec2 between = b.body->place - a.body->place;
  return overlap(a.lower, a.upper, b.lower + between, b.upper + between);
}

void findContacts(const SoftView& a, const SoftView& b, std::vector<SoftRow>& rows) {
  const Vec2 between = b.body->place - a.body->place;
  if (!mayMeet(a, b)) return;
  const double thick = a.body->radius + b.body->radius;
  const double skin = kSoftSkin * std::min(a.body->radius, b.body->radius);
  const Vec2 margin = {thick + skin, thick + skin};
  for (const int node : a.body->boundary) {
    const Vec2 from = a.body->nodes[at(node)].offset - between, to = a.ends[node] - between;
    const Vec2 least = {std::min(from.x, to.x), std::min(from.y, to.y)};
    const Vec2 most = {std::max(from.x, to.x), std::max(from.y, to.y)};
    if (!overlap(least - margin, most + margin, b.lower, b.upper)) continue;
    const Nearest near = nearestOn(*b.body, from);
    if (near.segment < 0) continue;
    const int nodes[] = {firstOf(*b.body, near.segment), secondOf(*b.body, near.segment)};
    const double t = near.part, gap = near.distance - thick;
    const Vec2 goes = (to - from) - (1 - t) * (b.ends[nodes[0]] - b.body->nodes[at(nodes[0])].offset) -
                      t * (b.ends[nodes[1]] - b.body->nodes[at(nodes[1])].offset);
    if (std::min(gap, gap + dot(goes, near.normal)) > skin) continue;
    SoftRow row;
    row.a = {a.id, {node, -1}, {1, 0}};
    row.b = {b.id, {nodes[0], nodes[1]}, {1 - t, t}};
    row.axes[0] = near.normal;
    row.axes[1] = perpendicular(near.normal);
    row.gaps[0] = gap;
    row.friction = std::sqrt(a.body->friction * b.body->friction);
    row.key = keyOf(a.id, node, 1 << 20 | b.id, near.segment);
    rows.push_back(row);
  }
}

double freeFraction(const SoftBody& body, Vec2 from, Vec2 to, const SoftPose& rigid, double h) {
  const LocalPath local = localPath(body, from, to, rigid, h);
  double free = 1;
  if (!(lengthSquared(local.displacement) > 0)) return free;
  for (const ConvexShape& shape : rigid.obstacle->shapes) {
    // The node stops a little before the surface, so that it does not start inside the next time. If it
    // starts closer than that, it stops at a smaller distance.
    for (const double part : {0.5, 0.25, 0.1, 0.01, 0.0}) {
      ConvexShape thick = shape;
      thick.radius += part * body.radius;
      const RayHit hit = castRay(thick, local.from, local.displacement);
      if (hit.hit && hit.normal == Vec2{}) continue;  // the node starts inside
      if (hit.hit && hit.fraction < free) free = hit.fraction;
      break;
    }
  }
  return free;
}

}  // namespace naiad::physics
