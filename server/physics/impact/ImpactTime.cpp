#include "physics/impact/ImpactTime.h"

#include <algorithm>

#include "physics/numerics/PolynomialRoots.h"

namespace naiad::physics {

namespace {

// An interval in which the bodies overlap on both axes.
struct Overlap {
  Interval when;
  bool is_y_last;  // true if they overlapped on x first
};

int overlapIntervals(const RelativeMotion& m, Vec2 half, double horizon, Overlap out[5]) {
  Interval xs[3], ys[3];
  const int nx = insideIntervals(m.offset.x, m.velocity.x, m.acceleration.x, half.x, horizon, xs);
  if (nx == 0) return 0;
  const int ny = insideIntervals(m.offset.y, m.velocity.y, m.acceleration.y, half.y, horizon, ys);
  int count = 0;
  for (int i = 0, j = 0; i < nx && j < ny;) {
    const double begin = std::max(xs[i].begin, ys[j].begin), end = std::min(xs[i].end, ys[j].end);
    if (begin < end) out[count++] = {{begin, end}, ys[j].begin >= xs[i].begin};
    (xs[i].end < ys[j].end ? i : j) += 1;
  }
  return count;
}

// Returns when |r + v·s + ½a·s²| fell below `half` before the moment `inside`, at which it is below.
double entryBefore(double r, double v, double a, double half, double inside) {
  Interval stretches[3];
  const int count = insideIntervals(r, v, a, half, inside, stretches);
  return count > 0 && stretches[count - 1].end == inside ? stretches[count - 1].begin : inside;
}

RelativeMotion movedOn(const RelativeMotion& m, double s) {
  return {m.offset + s * m.velocity + (0.5 * s * s) * m.acceleration, m.velocity + s * m.acceleration,
          m.acceleration};
}

// Finds the first moment at which |offset| falls below the radius less the slop. Returns it if the pair
// rests, otherwise the last moment before it at which |offset| fell below the radius; −1 if it never does.
double circleEntry(const RelativeMotion& m, double radius, double horizon, bool is_resting) {
  const double inner = radius - kImpactSlop;
  if (!(inner > 0)) return -1;
  Overlap near[5];
  const int count = overlapIntervals(m, {radius, radius}, horizon, near);
  for (int i = 0; i < count; ++i) {
    // Measures time from the entry into the square around the circle: a distant start then costs no digits.
    const double start = near[i].when.begin, length = near[i].when.end - start;
    const RelativeMotion here = movedOn(m, start);
    const Vec2 r = here.offset, v = here.velocity, a = 0.5 * here.acceleration;
    const int degree = a == Vec2{} ? 2 : 4;
    double c[5] = {lengthSquared(r) - inner * inner, 2 * dot(r, v), lengthSquared(v) + 2 * dot(r, a),
                   2 * dot(v, a), lengthSquared(a)};
    const double deep = firstBelowZero(c, degree, 0, length);
    if (deep < 0) continue;
    if (is_resting) return start + deep;
    c[0] = lengthSquared(r) - radius * radius;
    return start + lastFallBelowZero(c, degree, 0, deep);
  }
  return -1;
}

// Finds when the boxes overlap by more than the slop on both axes, then goes back to the moment when the
// distance on the axis that overlapped last fell to `reach`.
ImpactForecast boxEntry(const RelativeMotion& m, Vec2 reach, double horizon, bool is_resting) {
  Overlap overlap[5];
  if (overlapIntervals(m, reach - Vec2{kImpactSlop, kImpactSlop}, horizon, overlap) == 0) return {};
  const double deep = overlap[0].when.begin;
  const bool is_y = overlap[0].is_y_last;
  const ImpactAxis axis = is_y ? ImpactAxis::kY : ImpactAxis::kX;
  if (is_resting || deep == 0) return {deep, axis};
  return {is_y ? entryBefore(m.offset.y, m.velocity.y, m.acceleration.y, reach.y, deep)
               : entryBefore(m.offset.x, m.velocity.x, m.acceleration.x, reach.x, deep),
          axis};
}

// A circle touches a box when its centre enters the rounded box: two boxes, and four circles at the corners.
ImpactForecast roundedBoxEntry(const RelativeMotion& m, Vec2 half, double radius, double horizon,
                               bool is_resting) {
  ImpactForecast first;
  const auto take = [&](double time) {
    if (time >= 0 && (first.time < 0 || time < first.time)) first.time = time;
  };
  const double inner = radius - kImpactSlop;
  Overlap overlap[5];
  if (overlapIntervals(m, half + Vec2{radius, radius}, horizon, overlap) == 0) return {};
  if (overlapIntervals(m, {half.x + inner, half.y}, horizon, overlap) > 0) {
    const double deep = overlap[0].when.begin;
    const bool is_face = !is_resting && !overlap[0].is_y_last;
    take(is_face ? entryBefore(m.offset.x, m.velocity.x, m.acceleration.x, half.x + radius, deep) : deep);
  }
  if (overlapIntervals(m, {half.x, half.y + inner}, horizon, overlap) > 0) {
    const double deep = overlap[0].when.begin;
    const bool is_face = !is_resting && overlap[0].is_y_last;
    take(is_face ? entryBefore(m.offset.y, m.velocity.y, m.acceleration.y, half.y + radius, deep) : deep);
  }
  for (const Vec2 corner : {Vec2{-half.x, -half.y}, Vec2{half.x, -half.y}, Vec2{-half.x, half.y}, half}) {
    take(circleEntry({m.offset - corner, m.velocity, m.acceleration}, radius, horizon, is_resting));
  }
  return first;
}

ImpactTouch centreTouch(Vec2 offset, double radius) {
  const double distance = length(offset);
  if (distance == 0) return {{0, 1}, -radius};
  return {offset / distance, distance - radius, 1 / distance};
}

ImpactTouch boxTouch(Vec2 offset, Vec2 reach, ImpactAxis axis) {
  const double gap_x = std::fabs(offset.x) - reach.x, gap_y = std::fabs(offset.y) - reach.y;
  if (axis == ImpactAxis::kX || (axis == ImpactAxis::kNearest && gap_x > gap_y)) {
    return {{offset.x < 0 ? -1.0 : 1.0, 0}, gap_x, 0, -gap_y};
  }
  return {{0, offset.y < 0 ? -1.0 : 1.0}, gap_y, 0, -gap_x};
}

// Returns the contact of a circle with a box; `offset` is from the box's centre to the circle's.
ImpactTouch roundedBoxTouch(Vec2 offset, Vec2 half, double radius) {
  const Vec2 nearest = {std::clamp(offset.x, -half.x, half.x), std::clamp(offset.y, -half.y, half.y)};
  const Vec2 out = offset - nearest;
  if (out.x != 0 && out.y != 0) return centreTouch(out, radius);
  ImpactTouch touch = boxTouch(offset, half, ImpactAxis::kNearest);
  touch.gap -= radius;
  touch.overlap = 1;
  return touch;
}

// A pair of a box and a circle; `is_turned` if the box is the second one.
struct BoxAndCircle {
  Vec2 half;
  double radius;
  bool is_turned;
};
BoxAndCircle boxAndCircle(const ImpactBody& a, const ImpactBody& b) {
  if (a.shape == ImpactShape::kBox) return {a.half, b.half.x, false};
  return {b.half, a.half.x, true};
}

bool areBoxes(const ImpactBody& a, const ImpactBody& b) {
  return a.shape == ImpactShape::kBox && b.shape == ImpactShape::kBox;
}
bool areCircles(const ImpactBody& a, const ImpactBody& b) {
  return a.shape == ImpactShape::kCircle && b.shape == ImpactShape::kCircle;
}

// Returns when |r + v·s + ½a·s²| first crosses `half`; −1 if it never does, or is there now.
double crossingOf(double r, double v, double a, double half, double horizon) {
  constexpr double kClear = 1e-12;  // metric cells; a point this near to the edge is on it, within rounding
  const double off = std::fabs(r) - half;
  if (std::fabs(off) <= kClear) return -1;
  Interval stretches[3];
  if (insideIntervals(r, v, a, half, horizon, stretches) == 0) return -1;
  const double crossing = off > 0 ? stretches[0].begin : stretches[0].end;
  return crossing > 0 && crossing < horizon ? crossing : -1;
}

}  // namespace

ImpactTouch touchOf(const ImpactBody& a, const ImpactBody& b, Vec2 offset, ImpactAxis axis) {
  if (areBoxes(a, b)) return boxTouch(offset, a.half + b.half, axis);
  if (areCircles(a, b)) return centreTouch(offset, a.half.x + b.half.x);
  const BoxAndCircle pair = boxAndCircle(a, b);
  if (!pair.is_turned) return roundedBoxTouch(offset, pair.half, pair.radius);
  ImpactTouch touch = roundedBoxTouch(-offset, pair.half, pair.radius);
  touch.normal = -touch.normal;
  return touch;
}

ImpactForecast forecastImpact(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& motion,
                              double horizon, double rest_speed, bool is_resting) {
  const ImpactTouch now = touchOf(a, b, motion.offset);
  const double depth = std::min(now.gap, 0.0);  // an overlap at the start must not become deeper
  if (now.gap <= 0 && now.overlap > kImpactSlop && dot(motion.velocity, now.normal) < -rest_speed) {
    if (!areBoxes(a, b)) return {0, ImpactAxis::kNearest};
    return {0, now.normal.x != 0 ? ImpactAxis::kX : ImpactAxis::kY};
  }
  if (areBoxes(a, b)) {
    Vec2 reach = a.half + b.half;
    (now.normal.x != 0 ? reach.x : reach.y) += depth;
    return boxEntry(motion, reach, horizon, is_resting);
  }
  if (areCircles(a, b)) {
    return {circleEntry(motion, a.half.x + b.half.x + depth, horizon, is_resting), ImpactAxis::kNearest};
  }
  const BoxAndCircle pair = boxAndCircle(a, b);
  const RelativeMotion seen =
      pair.is_turned ? RelativeMotion{-motion.offset, -motion.velocity, -motion.acceleration} : motion;
  if (pair.radius + depth <= 0) {  // the centre is inside, so only the nearest face counts
    Vec2 reach = pair.half;
    (now.normal.x != 0 ? reach.x : reach.y) += pair.radius + depth;
    return {boxEntry(seen, reach, horizon, is_resting).time, ImpactAxis::kNearest};
  }
  return roundedBoxEntry(seen, pair.half, pair.radius + depth, horizon, is_resting);
}

double forecastEdge(const ImpactBody& a, const ImpactBody& b, const RelativeMotion& m, ImpactAxis axis,
                    double horizon) {
  if (areCircles(a, b)) return -1;
  if (areBoxes(a, b)) {
    const Vec2 reach = a.half + b.half - Vec2{kImpactSlop, kImpactSlop};
    return axis == ImpactAxis::kX ? crossingOf(m.offset.y, m.velocity.y, m.acceleration.y, reach.y, horizon)
                                  : crossingOf(m.offset.x, m.velocity.x, m.acceleration.x, reach.x, horizon);
  }
  const Vec2 half = boxAndCircle(a, b).half;
  const double x = crossingOf(m.offset.x, m.velocity.x, m.acceleration.x, half.x, horizon);
  const double y = crossingOf(m.offset.y, m.velocity.y, m.acceleration.y, half.y, horizon);
  return x < 0 || (y >= 0 && y < x) ? y : x;
}

}  // namespace naiad::physics
