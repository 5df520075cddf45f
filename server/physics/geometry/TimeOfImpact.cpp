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

// Returns when the circles around the bodies' origins overlap: only then can they touch. from > to: never.
Span nearTimes(Vec2 offset, Vec2 displacement, double reach) {
  const double speed = length(displacement);
  if (speed == 0) return lengthSquared(offset) <= reach * reach ? Span{0, 1} : Span{1, 0};
  const double passes = cross(displacement, offset) / speed, inside = (reach - passes) * (reach + passes);
  if (inside < 0) return {1, 0};
  const double middle = -dot(offset, displacement) / speed / speed, half = std::sqrt(inside) / speed;
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

// The corners of one shape as seen along an axis: their positions and speeds.
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

  // Sets one corner, for a disc that contains the shape at any rotation.
  explicit Corners(double reach) : count(1) {
    place[0] = reach;
    speed[0] = 0;
  }

  // Returns the corner that is foremost after `time` if all corners move straight.
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

// Returns how long the gap along the axis is safe, at most `longest`. For that time every pair of corners has
// place + speed·t − bend·t²/2 > 0.
double safeTime(const Corners& a, const Corners& b, double place, double speed, double bend, double longest) {
  double time = longest;
  std::int32_t last_a = -1, last_b = -1;
  // Each round takes the pair with the smallest gap at the time found so far. The gap of each pair is
  // concave, so its root does not have to be computed again.
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

// If the sizes of a pair differ by a larger factor, the pair is treated as a wall and something small.
constexpr double kFarLarger = 16;

// Radians, about a turn. A shape that turns by more is treated as a disc while the other one is far away.
constexpr double kFastTurn = 6.3;

// The motions and rotated shapes of a pair at one moment of its advancement.
struct View {
  const RigidMotion &motion_a, &motion_b;
  const RotatedShape &a, &b;
  Vec2 apart, velocity, acceleration;
  double radii, level, farthest, speed, left;

  // Returns how long the pair is safe along an axis that turns by `axis_turn`. Discs ignore their rotation.
  double safe(Vec2 normal, double axis_turn, bool a_is_disc = false, bool b_is_disc = false) const {
    const double turn_a = motion_a.turn - axis_turn, turn_b = motion_b.turn - axis_turn;
    // The corners of A are measured forwards along the axis, those of B backwards.
    const Corners of_a = a_is_disc ? Corners(a.reach) : Corners(a, normal, turn_a);
    const Corners of_b = b_is_disc ? Corners(b.reach) : Corners(b, -normal, turn_b);
    // Maximum curvature of paths along the axis: corners turn about their origins, and these about the axis.
    double bend = (a_is_disc ? 0 : a.reach * turn_a * turn_a) + (b_is_disc ? 0 : b.reach * turn_b * turn_b) +
                  std::fabs(axis_turn) * (farthest * std::fabs(axis_turn) + 2 * speed);
    if (acceleration != Vec2{}) {
      // A turning axis changes the part of the acceleration along it. If the shapes are driven apart, the
      // tangent is the bound, and the steps are those of Newton's method.
      const double change = std::min(std::fabs(axis_turn) * left, 2.0) * length(acceleration);
      bend = std::max(bend - dot(normal, acceleration) + change, 0.0);
    }
    const double place = dot(normal, apart) - radii - level;
    const double rate = dot(normal, velocity) + axis_turn * dot(perpendicular(normal), apart);
    return safeTime(of_a, of_b, place, rate, bend, left);
  }
};

// Returns a disc around the origin that contains every shape within `reach`.
RotatedShape discAround(double reach) {
  RotatedShape disc;
  disc.count = 1;
  disc.radius = disc.reach = reach;
  disc.vertices[0] = disc.normals[0] = {};
  return disc;
}

}  // namespace

// The large size of a shape next to a small one affects only the rounding errors in the tolerance.
double impactTolerance(const ConvexShape& a, const ConvexShape& b, Vec2 offset, Vec2 relative_displacement) {
  const double size_a = a.reach + a.radius, size_b = b.reach + b.radius, both = size_a + size_b;
  const double near = std::min(both, kFarLarger * std::min(size_a, size_b));
  return 1e-10 * near + 1e-15 * ((both - near) + length(offset) + length(relative_displacement));
}

TimeOfImpact timeOfImpact(const ConvexShape& a, const RigidMotion& motion_a, const ConvexShape& b,
                          const RigidMotion& motion_b, Vec2 offset, double target, double give) {
  const Vec2 start_velocity = motion_b.displacement - motion_a.displacement;
  const Vec2 acceleration = motion_b.acceleration - motion_a.acceleration;
  const bool is_straight = acceleration == Vec2{};
  // The straight line from start to end, from which the path departs at most by `bulge`.
  const Vec2 displacement = is_straight ? start_velocity : start_velocity + 0.5 * acceleration;
  const double bulge = is_straight ? 0 : 0.125 * length(acceleration);
  const double tolerance = impactTolerance(a, b, offset, displacement), radii = a.radius + b.radius;
  const double speed = is_straight ? length(displacement)
                                   : std::max(length(start_velocity), length(start_velocity + acceleration));
  TimeOfImpact result;
  const double around = a.reach + b.reach + radii + target;
  const Span span = nearTimes(offset, displacement, around * (1 + 1e-6) + 16 * tolerance + bulge);
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
    const Vec2 velocity = is_straight ? start_velocity : start_velocity + time * acceleration;
    const Vec2 apart =
        is_straight ? offset + time * displacement : offset + (0.5 * time) * (start_velocity + velocity);
    const Separation s = separation(turned_a, turned_b, apart);
    const double gap = s.distance - radii;
    if (first && time == 0 && gap <= target + tolerance) {
      result.touched_before = true;
      level = gap - 4 * tolerance;
      if (give > 0 && gap > target - 3 * give) level -= give;
    } else if (!is_straight && gap > target + 2 * tolerance) {
      level = target;  // they have parted, and may meet again
    }
    const auto hit = [&] {
      result.status = TimeOfImpactStatus::kHit;
      result.time = time, result.gap = gap, result.normal = s.normal;
      return result;
    };
    if (gap - level <= tolerance) return hit();
    const double left = span.to - time;
    const double farthest = std::max(length(apart), length(offset + span.to * displacement)) + bulge;
    const View view = {motion_a,     motion_b, turned_a, turned_b, apart, velocity,
                       acceleration, radii,    level,    farthest, speed, left};
    // A shape that turns fast is a disc while the other shape is farther away than it moves in about a turn.
    // After that its corners are used, which touch the other shape within a turn if it comes closer.
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
    // An axis across an edge turns with the edge. Otherwise the edge's far end would seem to approach.
    const double axis_turn = s.feature == Feature::kFaceA   ? motion_a.turn
                             : s.feature == Feature::kFaceB ? motion_b.turn
                                                            : 0;
    double safe = view.safe(s.normal, axis_turn);
    // If the axis turns, the far corners of a long shape seem to have bent paths: try a fixed axis, too.
    if (is_uneven && axis_turn != 0) safe = std::max(safe, view.safe(s.normal, 0));
    if (safe >= left) return result;
    if (time + safe == time) return hit();  // nearer than a double resolves in time
    time += safe;
  }
  --result.iterations;
  result.status = TimeOfImpactStatus::kUnresolved;
  result.time = time;
  return result;
}

}  // namespace naiad::physics
