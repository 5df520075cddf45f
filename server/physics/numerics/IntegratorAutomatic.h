// The error-controlled integrators behind one call, and how the automatic one decides.
#pragma once

#include <algorithm>

#include "physics/numerics/Integrator.h"
#include "physics/numerics/IntegratorExtrapolation.h"
#include "physics/numerics/IntegratorRadau.h"

namespace naiad::physics {

namespace automatic {

/// Derivatives that a smooth motion never needs in one call: above it the implicit method may be the better
/// one.
inline constexpr int kManyEvaluations = 1500;
/// Steps of the implicit method in which it must finish the call. A lasting oscillation would take it many
/// more.
inline constexpr int kTrialSteps = 300;

/// Extrapolation; when that is slow, Radau on trial; then extrapolation again, up to the limit; at last Radau
/// for good.
template <int N, class System>
IntegratorStatus integrate(const System& system, double t, double end, StateVector<N>& y,
                           const IntegratorOptions& options, IntegratorCounters& counters) {
  IntegratorOptions trial = options;
  trial.max_evaluations = std::min(options.max_evaluations, kManyEvaluations);
  trial.max_steps = std::min(options.max_steps, kTrialSteps);
  IntegratorStatus status = integrateByExtrapolation<N>(system, t, end, y, trial, counters, true);
  if (status == IntegratorStatus::kTooManySteps) {
    double t_stiff = t;
    StateVector<N> y_stiff = y;
    if (integrateByRadau<N>(system, t_stiff, end, y_stiff, trial, counters) == IntegratorStatus::kDone) {
      ++counters.stiff_calls;
      y = y_stiff;
      return IntegratorStatus::kDone;
    }
    status = integrateByExtrapolation<N>(system, t, end, y, options, counters, true);
  }
  if (status == IntegratorStatus::kDone || status == IntegratorStatus::kNotFinite) return status;
  ++counters.stiff_calls;
  return integrateByRadau<N>(system, t, end, y, options, counters);
}

}  // namespace automatic

/// From `t` to `end` >= t by kExtrapolation, kRadau or, for any other method, automatically. What that
/// decides depends on the arguments alone. `y` is as far as it came, at the end if the status is kDone.
template <int N, class System>
IntegratorStatus integrate(const System& system, double t, double end, StateVector<N>& y,
                           const IntegratorOptions& options, IntegratorCounters& counters) {
  IntegratorStatus status;
  switch (options.method) {
    case IntegratorMethod::kExtrapolation:
      status = integrateByExtrapolation<N>(system, t, end, y, options, counters, false);
      break;
    case IntegratorMethod::kRadau:
      status = integrateByRadau<N>(system, t, end, y, options, counters);
      break;
    default:
      status = automatic::integrate<N>(system, t, end, y, options, counters);
  }
  if (!isUsable<N>(y)) status = IntegratorStatus::kNotFinite;
  if (status != IntegratorStatus::kDone) ++counters.failed_calls;
  return status;
}

}  // namespace naiad::physics
