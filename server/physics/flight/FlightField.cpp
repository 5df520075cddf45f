#include "physics/flight/FlightField.h"

#include <cmath>

#include "physics/numerics/IntegratorAutomatic.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace {

// A body in a field as a system of first order: position, velocity. Time counts from the start of the call,
// so that steps may be short however long the world has been running.
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

// A field that turns the body by more radians in one call, as a strong magnet does, is not followed from turn
// to turn.
constexpr double kManyRadians = 64;
constexpr int kTurningSteps = 16;  // instead; four calls of the field each

constexpr Vec2 times(Vec2 a, Vec2 b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
constexpr Vec2 over(Vec2 a, Vec2 b) {
  return times(a, {b.x, -b.y}) / lengthSquared(b);
}

// Two calls say whether it can be so.
bool mayTurnFast(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t) {
  if (velocity == Vec2{}) velocity = {1, 0};
  const Vec2 change = field.acceleration(position, velocity, time) - field.acceleration(position, {}, time);
  return lengthSquared(change) * t * t > kManyRadians * kManyRadians * lengthSquared(velocity);
}

// v' = λv + rest, in closed form from step to step. So the speed stays what it is while the body turns,
// however fast, and drifts across another force as it should.
bool flyTurning(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t, Flown& flown) {
  if (!mayTurnFast(field, position, velocity, time, t)) return false;
  const double h = t / kTurningSteps;
  Vec2 moved;
  for (int i = 0; i < kTurningSteps; ++i) {
    const Turning turning = turningAt(field, position + moved, velocity, time + i * h);
    const bool is_fast = std::fabs(turning.lambda.y) * t > kManyRadians &&
                         std::fabs(turning.lambda.x) < std::fabs(turning.lambda.y);
    if (!is_fast) return false;  // damping, or out of the magnet
    const Vec2 lambda = turning.lambda, drift = -over(turning.rest, lambda), own = velocity - drift;
    const double left = df::math::exp(lambda.x * h);
    const Vec2 turned = {left * df::math::cos(lambda.y * h), left * df::math::sin(lambda.y * h)};
    moved += over(times(turned - Vec2{1, 0}, own), lambda) + h * drift;
    velocity = drift + times(turned, own);
  }
  flown = {moved, velocity};
  return isFinite(moved) && isFinite(velocity);
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
  if (options.method == IntegratorMethod::kAutomatic && flyTurning(field, position, velocity, time, t, flown))
    return IntegratorStatus::kDone;
  StateVector<4> y = {position.x, position.y, velocity.x, velocity.y};
  const IntegratorStatus status = integrate<4>(FieldSystem{field, time}, 0, t, y, options, counters);
  flown = {Vec2{y[0], y[1]} - position, {y[2], y[3]}};
  return status;
}

}  // namespace naiad::physics
