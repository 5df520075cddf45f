// One call for all error-controlled integrators, and the choice of the automatic method.
#pragma once

#include <algorithm>

#include "physics/numerics/Integrator.h"
#include "physics/numerics/IntegratorExtrapolation.h"
#include "physics/numerics/IntegratorRadau.h"

namespace naiad::physics {

namespace automatic {

/// Evaluations per call that smooth motion never needs: if it takes more, the implicit method may be faster.
inline constexpr int kManyEvaluations = 1500;
/// The implicit method is used for a call only if it needs at most this many steps. A lasting oscillation
/// would need many more.
inline constexpr int kTrialSteps = 100;
/// Limits of one call, each about half a millisecond.
inline constexpr int kMaxEvaluations = 8000;
inline constexpr int kMaxSteps = 600;
inline constexpr int kEvaluationsAtLeast = 150;  ///< limit up to which a call starts with Radau
inline constexpr int kCoarseSteps = 16;          ///< steps of integrateCoarsely(), the last resort
/// Factor by which Radau's tolerances grow after each third of the steps that it may take.
inline constexpr double kLoosening = 100;
/// The expected evaluations may be this many times the limit, because next to a jump of the force the steps
/// are short for a while.
inline constexpr int kPatience = 2;

/// Uses extrapolation; if that is slow, tries Radau; if that fails, extrapolation again, up to the limit.
template <int N, class System>
IntegratorStatus integrateExactly(const System& system, double& t, double end, StateVector<N>& y,
                                  const IntegratorOptions& limited, IntegratorCounters& counters) {
  IntegratorOptions trial = limited;
  trial.max_evaluations = std::min(limited.max_evaluations, kManyEvaluations);
  trial.max_steps = std::min(limited.max_steps, kTrialSteps);
  IntegratorStatus status = integrateByExtrapolation<N>(system, t, end, y, trial, counters, 1);
  if (status != IntegratorStatus::kTooManySteps) return status;
  double t_stiff = t;
  StateVector<N> y_stiff = y;
  status = integrateByRadau<N>(system, t_stiff, end, y_stiff, trial, counters);
  if (status == IntegratorStatus::kDone) {
    ++counters.stiff_calls;
  } else {
    status = integrateByExtrapolation<N>(system, t, end, y, limited, counters, kPatience);
  }
  if (t_stiff > t && isUsable<N>(y_stiff)) t = t_stiff, y = y_stiff;
  return status;
}

/// If extrapolation fails, continues with Radau, whose tolerances grow as its steps are used up, and at last
/// without error control. So it always reaches the end, unless numbers are not finite or steps shrink to
/// nothing. If the limit of evaluations is too low to detect stiffness, starts with Radau.
template <int N, class System>
IntegratorStatus integrate(const System& system, double t, double end, StateVector<N>& y,
                           const IntegratorOptions& options, IntegratorCounters& counters) {
  IntegratorOptions limited = options;
  limited.max_evaluations = std::min(options.max_evaluations, kMaxEvaluations);
  limited.max_steps = std::min(options.max_steps, kMaxSteps);
  const auto isOver = [](IntegratorStatus status) {
    return status == IntegratorStatus::kDone || status == IntegratorStatus::kNotFinite;
  };
  IntegratorStatus status = IntegratorStatus::kTooManySteps;
  if (options.max_evaluations > kEvaluationsAtLeast)
    status = integrateExactly<N>(system, t, end, y, limited, counters);
  if (isOver(status)) return status;
  ++counters.stiff_calls;
  status = integrateByRadau<N>(system, t, end, y, limited, counters, kLoosening);
  if (status != IntegratorStatus::kTooManySteps) return status;
  ++counters.coarse_calls;
  return integrateCoarsely<N>(system, t, end, y, kCoarseSteps, limited, counters);
}

}  // namespace automatic

/// Integrates from `t` to `end` >= t by kExtrapolation, kRadau or, for any other method, automatically. The
/// automatic choice depends only on the arguments. Sets `y` to the state reached, which is at `end` if kDone.
template <int N, class System>
IntegratorStatus integrate(const System& system, double t, double end, StateVector<N>& y,
                           const IntegratorOptions& options, IntegratorCounters& counters) {
  IntegratorStatus status;
  switch (options.method) {
    case IntegratorMethod::kExtrapolation:
      status = integrateByExtrapolation<N>(system, t, end, y, options, counters, 0);
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
