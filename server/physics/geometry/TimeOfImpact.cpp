#include "physics/geometry/TimeOfImpact.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"
#include "physics/geometry/ShapeDistance.h"

namespace naiad::physics {

namespace {

struct Span {
  double from;
  double to;
};

// While the circles around the bodies' origins overlap: nothing else can touch. Empty: from > to.
Span nearTimes(Vec2 offset, Vec2 displacement, double reach) {
  const double speed = length(displacement);
  if (speed == 0) return lengthSquared(offset) <= reach * reach ? Span{0, 1} : Span{1, 0};
  const double passes = cross(displacement, offset) / speed, inside = (reach - passes) * (reach + passes);
  if (inside < 0) return {1, 0};
  const double middle = -dot(offset, displacement) / speed / speed, half = std::sqrt(inside) / speed;
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

// The corners of one shape as an axis sees them: where they are and how fast they move along it.
struct Corners {
  std::int32_t count;
  std::array<double, kMaxVertices> place;
  std::array<double, kMaxVertices> speed;

  Corners(const RotatedShape& shape, Vec2 axis, double spin) : count(shape.count) {
    const Vec2 across = perpendicular(axis);
    for (std::int32_t i = 0; i < count; ++i) {
      place[at(i)] = dot(axis, shape.vertices[at(i)]);
      speed[at(i)] = -spin * dot(across, shape.vertices[at(i)]);
    }
  }

  // All that a shape is while it turns about its origin: it may turn as it likes.
  explicit Corners(double reach) : count(1) {
    place[0] = reach;
    speed[0] = 0;
  }

  // Which corner lies foremost after `time`, going straight on.
  std::int32_t foremost(double time) const {
    std::int32_t best = 0;
    double most = place[0] + speed[0] * time;
    for (std::int32_t i = 1; i < count; ++i) {
      const double p = place[at(i)] + speed[at(i)] * time;
      best = p > most ? i : best;
      most = p > most ? p : most;
    }
    return best;
  }
};

// How long the gap along the axis is safe: every pair of corners leaves at least
// place + speed·t − bend·t²/2 > 0 until then. At most `longest`.
double safeTime(const Corners& a, const Corners& b, double place, double speed, double bend, double longest) {
  double time = longest;
  std::int32_t last_a = -1, last_b = -1;
  // Each round takes the worst pair at the time found so far; each pair's path is concave, so its root is
  // final.
  for (std::int32_t round = 0; round < kMaxVertices * kMaxVertices; ++round) {
    const std::int32_t i = a.foremost(time), j = b.foremost(time);
    const double gap = place - a.place[at(i)] - b.place[at(j)];
    const double rate = speed - a.speed[at(i)] - b.speed[at(j)];
    if (gap <= 0) return 0;
    if (gap + (rate - 0.5 * bend * time) * time >= 0 || (i == last_a && j == last_b)) break;
    time = std::min(time, 2 * gap / (std::sqrt(rate * rate + 2 * bend * gap) - rate));
    last_a = i, last_b = j;
  }
  return time;
}

// A pair whose sizes differ by more than this is one of a wall and something small.
constexpr double kFarLarger = 16;

// A pair of which one turns by more than a turn is looked at as if that were a disc, while it is far away.
constexpr double kFastTurn = 6.3;

// Both at one time.
struct View {
  const RigidMotion &motion_a, &motion_b;
  const RotatedShape &a, &b;
  Vec2 apart, displacement;
  double radii, level, farthest, speed, left;

  // The time that is safe along an axis that turns by `axis_turn`. A disc looks the same however it turns.
  double safe(Vec2 normal, double axis_turn, bool a_is_disc = false, bool b_is_disc = false) const {
    const double turn_a = motion_a.turn - axis_turn, turn_b = motion_b.turn - axis_turn;
    // A's corners count forwards along the axis, B's backwards.
    const Corners of_a = a_is_disc ? Corners(a.reach) : Corners(a, normal, turn_a);
    const Corners of_b = b_is_disc ? Corners(b.reach) : Corners(b, -normal, turn_b);
    // No path along the axis bends more than this: the corners about their origins, and these about the axis.
    const double bend = (a_is_disc ? 0 : a.reach * turn_a * turn_a) +
                        (b_is_disc ? 0 : b.reach * turn_b * turn_b) +
                        std::fabs(axis_turn) * (farthest * std::fabs(axis_turn) + 2 * speed);
    const double place = dot(normal, apart) - radii - level;
    const double rate = dot(normal, displacement) + axis_turn * dot(perpendicular(normal), apart);
    return safeTime(of_a, of_b, place, rate, bend, left);
  }
};

// As far as everything reaches that turns about the origin.
RotatedShape discAround(double reach) {
  RotatedShape disc;
  disc.count = 1;
  disc.radius = disc.reach = reach;
  disc.vertices[0] = disc.normals[0] = {};
  return disc;
}

}  // namespace

// A small shape at a large one is found as exactly as the large one's numbers allow, not as its size.
double impactTolerance(const ConvexShape& a, const ConvexShape& b, Vec2 offset, Vec2 relative_displacement) {
  const double size_a = a.reach + a.radius, size_b = b.reach + b.radius, both = size_a + size_b;
  const double near = std::min(both, kFarLarger * std::min(size_a, size_b));
  return 1e-10 * near + 1e-15 * ((both - near) + length(offset) + length(relative_displacement));
}

TimeOfImpact timeOfImpact(const ConvexShape& a, const RigidMotion& motion_a, const ConvexShape& b,
                          const RigidMotion& motion_b, Vec2 offset, double target) {
  const Vec2 displacement = motion_b.displacement - motion_a.displacement;
  const double tolerance = impactTolerance(a, b, offset, displacement), radii = a.radius + b.radius;
  const double speed = length(displacement);
  TimeOfImpact result;
  const double around = a.reach + b.reach + radii + target;
  const Span span = nearTimes(offset, displacement, around * (1 + 1e-6) + 16 * tolerance);
  if (span.from > span.to) return result;

  const double size_a = a.reach + a.radius, size_b = b.reach + b.radius;
  const bool is_uneven = std::max(size_a, size_b) > kFarLarger * std::min(size_a, size_b);
  const double turn_most = std::max(std::fabs(motion_a.turn), std::fabs(motion_b.turn));
  const bool a_turns_more = std::fabs(motion_a.turn) == turn_most;
  RotatedShape turned_a, turned_b;
  double level = target, time = span.from;
  for (result.iterations = 1; result.iterations <= kImpactIterations; ++result.iterations) {
    const bool first = result.iterations == 1;
    if (first || motion_a.turn != 0) turn(a, turned(motion_a.start, motion_a.turn * time), turned_a);
    if (first || motion_b.turn != 0) turn(b, turned(motion_b.start, motion_b.turn * time), turned_b);
    const Vec2 apart = offset + time * displacement;
    const Separation s = separation(turned_a, turned_b, apart);
    const double gap = s.distance - radii;
    if (first && time == 0 && gap <= target + tolerance) {
      result.touched_before = true;
      level = gap - 4 * tolerance;
    }
    const auto hit = [&] {
      result.status = TimeOfImpactStatus::kHit;
      result.time = time, result.gap = gap, result.normal = s.normal;
      return result;
    };
    if (gap - level <= tolerance) return hit();
    const double left = span.to - time;
    const double farthest = std::max(length(apart), length(offset + span.to * displacement));
    const View view = {motion_a, motion_b, turned_a, turned_b, apart, displacement,
                       radii,    level,    farthest, speed,    left};
    // Until the disc comes nearer than it does in about a turn. Then its corners decide: within a turn, if it
    // goes on.
    if (turn_most * left > kFastTurn) {
      const Separation d = a_turns_more ? separation(discAround(a.reach), turned_b, apart)
                                        : separation(turned_a, discAround(b.reach), apart);
      const double room = d.distance - radii - (a_turns_more ? a.reach : b.reach) - level;
      if (room > tolerance + 6 * speed / turn_most) {
        const double turn_of_axis = d.feature == Feature::kFaceA   ? motion_a.turn
                                    : d.feature == Feature::kFaceB ? motion_b.turn
                                                                   : 0;
        const double safe = view.safe(d.normal, turn_of_axis, a_turns_more, !a_turns_more);
        if (safe >= left) return result;
        if (time + safe > time) {
          time += safe;
          continue;
        }
      }
    }
    // An axis across an edge turns with it, or else the edge's far end would seem to come nearer.
    const double axis_turn = s.feature == Feature::kFaceA   ? motion_a.turn
                             : s.feature == Feature::kFaceB ? motion_b.turn
                                                            : 0;
    double safe = view.safe(s.normal, axis_turn);
    // That bends the paths of a long shape's far corners, which are not there.
    if (is_uneven && axis_turn != 0) safe = std::max(safe, view.safe(s.normal, 0));
    if (safe >= left) return result;
    if (time + safe == time) return hit();  // nearer than a double of time resolves
    time += safe;
  }
  --result.iterations;
  result.status = TimeOfImpactStatus::kUnresolved;
  result.time = time;
  return result;
}

}  // namespace naiad::physics
