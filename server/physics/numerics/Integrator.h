// What all integrators share: the state, the settings, the result, what they count.
//
// A system is any type with
//     void derivative(double t, const StateVector<N>& y, StateVector<N>& rate) const;
// and, if it knows its Jacobian,
//     bool jacobian(double t, const StateVector<N>& y, StateMatrix<N>& by_state) const;   // false: take
//     differences
// The integrators are templates on the dimension and allocate nothing. They are pure functions: the same
// state, system and settings give the same bits, and nothing is remembered from one call to the next.
#pragma once

#include <array>
#include <cstdint>

namespace naiad::physics {

template <int N>
using StateVector = std::array<double, N>;

/// Row i holds the derivatives of rate i.
template <int N>
using StateMatrix = std::array<std::array<double, N>, N>;

enum class IntegratorMethod : std::uint8_t {
  kAutomatic,      ///< extrapolation; in a call in which that is slow, Radau if it is faster
  kExtrapolation,  ///< Gragg–Bulirsch–Stoer, order up to 16, error control: smooth motion to rounding, Kepler
  kRadau,          ///< Radau IIA of order 5, implicit, error control: stiff forces
};

enum class IntegratorStatus : std::uint8_t {
  kDone,
  kTooManySteps,  ///< the limit of the settings was reached
  kNoProgress,    ///< the step became too small: a singularity, or Newton's method does not converge
  kNotFinite,     ///< the state or the forces at its start are not finite
};

struct IntegratorOptions {
  IntegratorMethod method = IntegratorMethod::kAutomatic;

  /// What each error-controlled step of the explicit method may be wrong by, per component:
  /// absolute + relative · |component|.
  double relative = 1e-12;
  double absolute = 1e-12;
  /// The same for the implicit method, whose order makes the last digits expensive.
  double stiff_relative = 1e-8;
  double stiff_absolute = 1e-10;

  /// The explicit method gives up in a call when it needs more derivatives than this, or will at the pace of
  /// its steps.
  int max_evaluations = 30000;
  /// The implicit method gives up after as many steps, rejected ones among them. The automatic one has lower
  /// limits of its own, and larger tolerances before it gives up (IntegratorAutomatic.h).
  int max_steps = 20000;
};

/// Added up over calls. Nothing is ever reset but by the owner.
struct IntegratorCounters {
  std::int64_t evaluations = 0;      ///< of the derivative, those for Jacobians by differences among them
  std::int64_t steps = 0;            ///< accepted
  std::int64_t rejected = 0;         ///< because of the error estimate
  std::int64_t jacobians = 0;        ///< implicit only
  std::int64_t newton_failures = 0;  ///< steps repeated because Newton's method did not converge
  std::int64_t stiff_calls = 0;      ///< calls of the automatic method that went on with Radau
  std::int64_t coarse_calls = 0;     ///< of those, how many had to end without error control
  std::int64_t failed_calls = 0;     ///< calls that ended with a status other than kDone
};

}  // namespace naiad::physics
