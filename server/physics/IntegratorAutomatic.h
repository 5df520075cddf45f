// The error-controlled integrators behind one call.
#pragma once

#include "Integrator.h"
#include "IntegratorExtrapolation.h"
#include "IntegratorRadau.h"

namespace naiad::physics {

/// From `t` to `end` by kExtrapolation, kRadau or, for any other method, automatically: extrapolation; when
/// that has taken options.max_evaluations, or would by the end at the pace of its last step, Radau goes on
/// from there. That depends on the arguments alone. `y` is as far as it came, at the end if the status is
/// kDone.
template <int N, class System>
IntegratorStatus integrate(const System& system, double t, double end, StateVector<N>& y,
                           const IntegratorOptions& options, IntegratorCounters& counters) {
  IntegratorStatus status = IntegratorStatus::kTooManySteps;
  if (options.method != IntegratorMethod::kRadau) {
    status = integrateByExtrapolation<N>(system, t, end, y, options, counters);
  }
  const bool may_switch = options.method != IntegratorMethod::kExtrapolation;
  if (may_switch && status != IntegratorStatus::kDone && status != IntegratorStatus::kNotFinite) {
    if (options.method != IntegratorMethod::kRadau) ++counters.stiff_calls;
    status = integrateByRadau<N>(system, t, end, y, options, counters);
  }
  if (!isUsable<N>(y)) status = IntegratorStatus::kNotFinite;
  if (status != IntegratorStatus::kDone) ++counters.failed_calls;
  return status;
}

}  // namespace naiad::physics
