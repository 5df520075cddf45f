#include "physics/flight/FlightField.h"

#include <algorithm>
#include <cmath>

#include "physics/flight/FlightSpring.h"
#include "physics/numerics/IntegratorAutomatic.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace {

// A body in a field as a first-order system of position and velocity. Time counts from the start of the call,
// so that short steps are accurate even if the world has been running for long.
struct FieldSystem {
  const ForceField& field;
  double start;

  void derivative(double t, const StateVector<4>& y, StateVector<4>& rate) const {
    const Vec2 a = field.acceleration({y[0], y[1]}, {y[2], y[3]}, start + t);
    rate = {y[2], y[3], a.x, a.y};
  }

  bool jacobian(double t, const StateVector<4>& y, StateMatrix<4>& by_state) const {
    Mat22 p, v;
    if (!field.jacobian({y[0], y[1]}, {y[2], y[3]}, start + t, p, v)) return false;
    by_state = {{{0, 0, 1, 0}, {0, 0, 0, 1}, {p.xx, p.xy, v.xx, v.xy}, {p.yx, p.yy, v.yx, v.yy}}};
    return true;
  }
};

// If a field turns the velocity by more radians than this in one call, as a strong magnet does, the
// integrator does not follow every turn.
constexpr double kManyRadians = 64;
constexpr int kTurningSteps =
    16;  // number of steps that flyTurning() takes instead; each calls the field four times

constexpr Vec2 times(Vec2 a, Vec2 b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
constexpr Vec2 over(Vec2 a, Vec2 b) {
  return times(a, {b.x, -b.y}) / lengthSquared(b);
}

// True if the field may turn the velocity by more than kManyRadians. Calls the field twice.
bool mayTurnFast(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t) {
  if (velocity == Vec2{}) velocity = {1, 0};
  const Vec2 change = field.acceleration(position, velocity, time) - field.acceleration(position, {}, time);
  return lengthSquared(change) * t * t > kManyRadians * kManyRadians * lengthSquared(velocity);
}

// Solves v' = λv + rest in closed form, step by step. So a velocity that turns at any rate keeps its
// magnitude, and other forces cause the right drift. Returns false if the velocity does not turn fast enough.
bool flyTurning(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t, Flown& flown) {
  if (!mayTurnFast(field, position, velocity, time, t)) return false;
  const double h = t / kTurningSteps;
  Vec2 moved;
  for (int i = 0; i < kTurningSteps; ++i) {
    const Turning turning = turningAt(field, position + moved, velocity, time + i * h);
    const bool is_fast = std::fabs(turning.lambda.y) * t > kManyRadians &&
                         std::fabs(turning.lambda.x) < std::fabs(turning.lambda.y);
    if (!is_fast) return false;  // the body is damped, or outside the magnet
    const Vec2 lambda = turning.lambda, drift = -over(turning.rest, lambda), own = velocity - drift;
    const double left = df::math::exp(lambda.x * h);
    const Vec2 turned = {left * df::math::cos(lambda.y * h), left * df::math::sin(lambda.y * h)};
    moved += over(times(turned - Vec2{1, 0}, own), lambda) + h * drift;
    velocity = drift + times(turned, own);
  }
  flown = {moved, velocity};
  return isFinite(moved) && isFinite(velocity);
}

// A field in its principal directions, those of the largest and smallest stiffness: −k·x − c·x′ + `start`.
struct LinearField {
  Vec2 axis;  // direction of the largest stiffness
  Vec2 stiffness;
  double damping = 0;
  Vec2 start;  // acceleration of a body that is at rest at the start

  Vec2 turnedIn(Vec2 a) const { return {dot(axis, a), cross(axis, a)}; }
  Vec2 turnedOut(Vec2 a) const { return a.x * axis + a.y * perpendicular(axis); }
  Flown flownFor(Vec2 velocity, double t) const {
    const Vec2 v = turnedIn(velocity), a = turnedIn(start);
    const Flown x = flySpring({}, {v.x, 0}, {a.x, 0}, {stiffness.x, damping}, t);
    const Flown y = flySpring({}, {0, v.y}, {0, a.y}, {stiffness.y, damping}, t);
    return {turnedOut({x.displacement.x, y.displacement.y}), turnedOut({x.velocity.x, y.velocity.y})};
  }
  Vec2 accelerationAt(Vec2 moved, Vec2 velocity) const {
    const Vec2 d = turnedIn(moved);
    return start - turnedOut({stiffness.x * d.x, stiffness.y * d.y}) - damping * velocity;
  }
};

// Linearises the field by differences as large as the distance from the origin. These give the right
// stiffness only if the field is linear.
LinearField linearised(const ForceField& field, Vec2 position, Vec2 velocity, double time) {
  const double scale = length(position) > 0 ? length(position) : 1;
  const Vec2 here = field.acceleration(position, velocity, time);
  const Vec2 by_x = (field.acceleration(position + Vec2{scale, 0}, velocity, time) - here) / scale;
  const Vec2 by_y = (field.acceleration(position + Vec2{0, scale}, velocity, time) - here) / scale;
  const double mean = 0.5 * (by_x.x + by_y.y), apart = 0.5 * (by_x.x - by_y.y), across = by_x.y;
  const double half = std::sqrt(apart * apart + across * across);
  const Vec2 along = apart < 0 ? Vec2{apart - half, across} : Vec2{-across, apart + half};
  const Vec2 axis = length(along) > 0 ? along / length(along) : Vec2{1, 0};
  return {axis, {half - mean, -half - mean}, 0, here};
}

// Flies in a field that pulls in proportion to the distance, by the formula of a spring, because an
// integrator would need thousands of steps for a body that swings by many radians. Returns false if the field
// is not linear at the end of the swing or at some moments before.
bool flyLinear(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t, Flown& flown) {
  constexpr double kLinear = 1e-9;
  LinearField linear = linearised(field, position, velocity, time);
  const double stiffest = linear.stiffness.x;
  if (!(stiffest * t * t > kManyRadians * kManyRadians && stiffest < 1e30)) return false;
  linear.damping = std::max(0.0, -turningAt(field, position, velocity, time).lambda.x);
  linear.start += linear.damping * velocity;
  if (linear.stiffness.y < -kLinear * stiffest) return false;
  linear.stiffness.y = std::max(linear.stiffness.y, 0.0);
  const Vec2 across = {2 * linear.turnedIn(linear.start).x / stiffest, 0};
  const auto isLinearAt = [&](const Flown& at, double when) {
    const Vec2 there = field.acceleration(position + at.displacement, at.velocity, time + when);
    const Vec2 wrong = there - linear.accelerationAt(at.displacement, at.velocity);
    return length(wrong) <= kLinear * (length(linear.start) + stiffest * length(at.displacement));
  };
  if (!isLinearAt({linear.turnedOut(across), velocity}, 0)) return false;
  for (const double part : {0.37, 0.71, 1.0}) {
    flown = linear.flownFor(velocity, part * t);
    if (!isLinearAt(flown, part * t)) return false;
  }
  return isFinite(flown.displacement) && isFinite(flown.velocity);
}

}  // namespace

Turning turningAt(const ForceField& field, Vec2 position, Vec2 velocity, double time) {
  const double scale = length(velocity) > 0 ? length(velocity) : 1;
  const Vec2 at_rest = field.acceleration(position, {}, time);
  const Vec2 by_x = (field.acceleration(position, {scale, 0}, time) - at_rest) / scale;
  const Vec2 by_y = (field.acceleration(position, {0, scale}, time) - at_rest) / scale;
  const Vec2 lambda = {0.5 * (by_x.x + by_y.y), 0.5 * (by_x.y - by_y.x)};
  return {lambda, field.acceleration(position, velocity, time) - times(lambda, velocity)};
}

IntegratorStatus flyField(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t,
                          const IntegratorOptions& options, Flown& flown, IntegratorCounters& counters) {
  if (options.method == IntegratorMethod::kAutomatic &&
      (flyTurning(field, position, velocity, time, t, flown) ||
       flyLinear(field, position, velocity, time, t, flown))) {
    return IntegratorStatus::kDone;
  }
  StateVector<4> y = {position.x, position.y, velocity.x, velocity.y};
  const IntegratorStatus status = integrate<4>(FieldSystem{field, time}, 0, t, y, options, counters);
  flown = {Vec2{y[0], y[1]} - position, {y[2], y[3]}};
  return status;
}

}  // namespace naiad::physics
