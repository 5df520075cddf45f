// Radau IIA with three stages: implicit, of order 5, L-stable, error-controlled. For stiff systems.
//
// Hairer and Wanner, "Solving Ordinary Differential Equations II", IV.8: the stages' increments are the
// unknowns, a simplified Newton iteration with one decomposition per step, and an error estimate of order 3
// that is filtered by the stiff part itself. Dimensions here are small, so the 3N equations are solved as
// they stand.
#pragma once

#include "physics/numerics/IntegratorRadauStep.h"

namespace naiad::physics {

/// From `t` to `end` >= t. On return `t` and `y` are as far as it has come: the end, if the status is kDone.
/// `loosening`: by what the tolerances grow with each third of the steps that are allowed.
template <int N, class System>
IntegratorStatus integrateByRadau(const System& system, double& t, double end, StateVector<N>& y,
                                  const IntegratorOptions& options, IntegratorCounters& counters,
                                  double loosening = 1) {
  radau::Step<N, System> step(system, options, counters);
  double length = std::min(end - t, step.begin(t, y));
  bool is_first = true, was_rejected = false;
  for (int count = 0; t < end; ++count) {
    if (count >= options.max_steps) return IntegratorStatus::kTooManySteps;
    if (count == options.max_steps / 3) step.loosen(loosening);
    if (count == options.max_steps / 3 * 2) step.loosen(loosening * loosening);
    if (!isUsable<N>(step.rate())) return IntegratorStatus::kNotFinite;
    const double whole = end - t;
    if (length > 0.999 * whole) length = whole;
    if (t + length == t) return IntegratorStatus::kNoProgress;

    if (!step.solve(t, y, length)) {
      ++counters.newton_failures;
      length *= 0.25;
      was_rejected = true;
      continue;
    }
    const double error = step.error(t, y, length, is_first || was_rejected);
    const double factor = step.nextFactor(error);
    if (error < 1) {
      t = length == whole ? end : t + length;
      step.advance(t, y, length, t == end);
      ++counters.steps;
      length *= was_rejected ? std::min(factor, 1.0) : factor;
      is_first = was_rejected = false;
    } else {
      ++counters.rejected;
      length *= std::min(factor, is_first ? 0.1 : 0.9);
      was_rejected = true;
    }
  }
  return IntegratorStatus::kDone;
}

/// In so many equal steps, linearly implicit (Rosenbrock's of order 1): bounded at any stiffness, and without
/// error control.
template <int N, class System>
IntegratorStatus integrateCoarsely(const System& system, double t, double end, StateVector<N>& y, int steps,
                                   const IntegratorOptions& options, IntegratorCounters& counters) {
  radau::Step<N, System> step(system, options, counters);
  const double length = (end - t) / steps;
  for (int i = 0; i < steps; ++i) {
    if (!step.takeCoarsely(t + i * length, y, length) || !isUsable<N>(y)) return IntegratorStatus::kNotFinite;
  }
  return IntegratorStatus::kDone;
}

}  // namespace naiad::physics
