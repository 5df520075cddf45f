#include "physics/flight/FlightField.h"

#include "physics/flight/IntegratorFixed.h"
#include "physics/numerics/IntegratorAutomatic.h"

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

bool hasErrorControl(IntegratorMethod method) {
  return method == IntegratorMethod::kAutomatic || method == IntegratorMethod::kExtrapolation ||
         method == IntegratorMethod::kRadau;
}

}  // namespace

IntegratorStatus flyField(const ForceField& field, Vec2 position, Vec2 velocity, double time, double t,
                          const IntegratorOptions& options, Flown& flown, IntegratorCounters& counters) {
  if (hasErrorControl(options.method)) {
    StateVector<4> y = {position.x, position.y, velocity.x, velocity.y};
    const IntegratorStatus status = integrate<4>(FieldSystem{field, time}, 0, t, y, options, counters);
    flown = {Vec2{y[0], y[1]} - position, {y[2], y[3]}};
    return status;
  }
  FieldState state{position, velocity, time};
  integrateFixed(field, state, t, options, counters);
  flown = {state.position - position, state.velocity};
  if (isFinite(flown.displacement) && isFinite(flown.velocity)) return IntegratorStatus::kDone;
  ++counters.failed_calls;
  return IntegratorStatus::kNotFinite;
}

}  // namespace naiad::physics
