// Shared by all integrators: state, options, status, counters.
//
// A system is any type with
//     void derivative(double t, const StateVector<N>& y, StateVector<N>& rate) const;
// and, if it knows its Jacobian,
//     bool jacobian(double t, const StateVector<N>& y, StateMatrix<N>& by_state) const;
//     // false: use finite differences
// The integrators are templates on the dimension and allocate nothing. They are pure functions: equal state,
// system and options give equal bits, and no call remembers anything for the next.
#pragma once

#include <array>
#include <cstdint>

namespace naiad::physics {

template <int N>
using StateVector = std::array<double, N>;

/// A matrix; row i has the derivatives of rate i.
template <int N>
using StateMatrix = std::array<std::array<double, N>, N>;

enum class IntegratorMethod : std::uint8_t {
  kAutomatic,  ///< extrapolation; if that is slow in a call, Radau is tried and used if it needs few steps
  kExtrapolation,  ///< Gragg–Bulirsch–Stoer, order up to 16, error control: accurate to rounding for smooth
                   ///< motion and Kepler orbits
  kRadau,  ///< Radau IIA of order 5, implicit, error control: stiff forces
};

enum class IntegratorStatus : std::uint8_t {
  kDone,
  kTooManySteps,  ///< a limit of the options was exceeded, or would be at the present speed
  kNoProgress,    ///< the step became too small, because of a singularity or because Newton's method failed
  kNotFinite,     ///< the state or its derivative, at the start or after a step, is not finite
};

struct IntegratorOptions {
  IntegratorMethod method = IntegratorMethod::kAutomatic;

  /// Allowed error per component of each step of the explicit method: absolute + relative · |component|.
  double relative = 1e-12;
  double absolute = 1e-12;
  /// Allowed error of the implicit method, larger because the last digits are expensive at its order.
  double stiff_relative = 1e-8;
  double stiff_absolute = 1e-10;

  /// The explicit method fails if a call needs more evaluations than this; as a part of the automatic method
  /// also if the call would need more at its present speed.
  int max_evaluations = 30000;
  /// The implicit method fails after this many steps, including rejected ones. The automatic method has lower
  /// limits, and enlarges the tolerances before it fails (IntegratorAutomatic.h).
  int max_steps = 20000;
};

/// Counters added up over calls; only the owner resets them.
struct IntegratorCounters {
  std::int64_t evaluations = 0;  ///< evaluations of the derivative, also for finite-difference Jacobians
  std::int64_t steps = 0;        ///< steps accepted by the error estimate
  std::int64_t rejected = 0;     ///< steps rejected by the error estimate, or for a jump of the derivative
  std::int64_t jacobians = 0;    ///< Jacobians computed, by implicit methods only
  std::int64_t newton_failures = 0;  ///< steps repeated because Newton's method did not converge
  std::int64_t stiff_calls = 0;      ///< calls in which the automatic method changed to Radau
  std::int64_t coarse_calls = 0;     ///< stiff calls that had to finish without error control
  std::int64_t failed_calls = 0;     ///< calls with a final status other than kDone
};

}  // namespace naiad::physics
