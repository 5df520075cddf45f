#include "physics/flight/FlightDrag.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/numerics/IntegratorAutomatic.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace math = df::math;

namespace {

// Returns sin(x)/x or sinh(x)/x, given `value`; 1 near 0, where the quotient would be 0/0.
double quotient(double value, double x) {
  return x > 0x1p-500 ? value / x : 1;
}

// Computes a fall: velocity and acceleration have the same direction and are both >= 0.
FlownOnLine fall(double v, double a, double q, double t) {
  const double rate = std::sqrt(a * q);
  const double phase = rate * t;
  if (phase < 20) {
    const double half = math::sinh(0.5 * phase);
    const double path = t * quotient(math::sinh(phase), phase);
    const double growth = 2 * half * half + q * v * path;  // denominator minus 1
    return {math::log1p(growth) / q, (v * math::cosh(phase) + a * path) / (1 + growth)};
  }
  // cosh and sinh, divided by their common factor e^phase / 2:
  const double limit = std::sqrt(a / q), fast = v / limit;
  const double left = math::exp(-2 * phase);
  const double denominator = (1 + left) + fast * (1 - left);
  return {(phase + math::log(0.5 * denominator)) / q, (v * (1 + left) + limit * (1 - left)) / denominator};
}

}  // namespace

FlownOnLine flyQuadraticDragOnLine(double velocity, double acceleration, double drag, double t) {
  assert(drag >= 0 && t >= 0);
  const double sign = acceleration != 0 ? std::copysign(1.0, acceleration) : std::copysign(1.0, velocity);
  const double v = sign * velocity, a = sign * acceleration;
  if (drag * std::max(std::fabs(v), a * t) * t < 1e-290) {  // drag is too small to be noticed in a double
    return {velocity * t + 0.5 * acceleration * t * t, velocity + acceleration * t};
  }
  FlownOnLine flown{};
  if (v >= 0) {
    flown = fall(v, a, drag, t);
  } else {  // moves upward: like fall(), but with circular functions, up to the summit
    const double u = -v, rate = std::sqrt(a * drag);
    const double summit = rate > 0 ? math::atan2(u * drag, rate) / rate : math::kPi;
    if (t < summit) {
      const double phase = rate * t, half = math::sin(0.5 * phase);
      const double path = t * quotient(math::sin(phase), phase);
      const double growth = drag * u * path - 2 * half * half;
      flown = {-math::log1p(growth) / drag, -(u * math::cos(phase) - a * path) / (1 + growth)};
    } else {
      const double fast = u * drag / rate;
      flown = fall(0, a, drag, t - summit);
      flown.displacement -= 0.5 * math::log1p(fast * fast) / drag;
    }
  }
  return {sign * flown.displacement, sign * flown.velocity};
}

namespace {

// The system of displacement and velocity under quadratic drag.
struct QuadraticDrag {
  Vec2 acceleration;
  double drag;

  void derivative(double /*t*/, const StateVector<4>& y, StateVector<4>& rate) const {
    const double speed = std::sqrt(y[2] * y[2] + y[3] * y[3]);
    rate = {y[2], y[3], acceleration.x - drag * speed * y[2], acceleration.y - drag * speed * y[3]};
  }

  bool jacobian(double /*t*/, const StateVector<4>& y, StateMatrix<4>& by_state) const {
    const double speed = std::sqrt(y[2] * y[2] + y[3] * y[3]);
    const Vec2 direction = speed > 0 ? Vec2{y[2] / speed, y[3] / speed} : Vec2{};
    const double both = -drag * speed * direction.x * direction.y;
    by_state = {{{0, 0, 1, 0},
                 {0, 0, 0, 1},
                 {0, 0, -drag * speed * (1 + direction.x * direction.x), both},
                 {0, 0, both, -drag * speed * (1 + direction.y * direction.y)}}};
    return true;
  }
};

}  // namespace

IntegratorStatus flyQuadraticDrag(Vec2 velocity, Vec2 acceleration, double drag, double t, Flown& flown,
                                  IntegratorCounters& counters) {
  if (cross(velocity, acceleration) == 0) {
    const Vec2 along = acceleration == Vec2{} ? velocity : acceleration;
    const double size = length(along);
    if (size == 0) {
      flown = {};
      return IntegratorStatus::kDone;
    }
    const Vec2 direction = along / size;
    const auto line = flyQuadraticDragOnLine(dot(velocity, direction), dot(acceleration, direction), drag, t);
    flown = {line.displacement * direction, line.velocity * direction};
    return IntegratorStatus::kDone;
  }
  const QuadraticDrag system{acceleration, drag};
  StateVector<4> y = {0, 0, velocity.x, velocity.y};
  const double speed = length(velocity) + length(acceleration) * t;
  IntegratorOptions options;
  options.relative = 1e-13;
  options.absolute = 1e-13 * speed * std::min(t, 1.0);
  options.stiff_relative = 1e-9;  // used only if drag is so strong that it damps errors
  options.stiff_absolute = 1000 * options.absolute;
  const IntegratorStatus status = integrate<4>(system, 0, t, y, options, counters);
  flown = {{y[0], y[1]}, {y[2], y[3]}};
  return status;
}

}  // namespace naiad::physics
