// Radau IIA with three stages for stiff systems: implicit, order 5, L-stable, error-controlled.
//
// See Hairer and Wanner, "Solving Ordinary Differential Equations II", IV.8. The unknowns are the stages'
// increments, found by simplified Newton iteration with one decomposition per step. The error estimate has
// order 3, and its stiff part is damped. The 3N equations are solved directly, because N is small.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/numerics/DenseSolve.h"
#include "physics/numerics/Integrator.h"
#include "physics/numerics/IntegratorExtrapolation.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace radau {

inline constexpr double kRoot6 = 0x1.3988e1409212ep+1;
inline constexpr std::array<double, 3> kNodes = {(4 - kRoot6) / 10, (4 + kRoot6) / 10, 1};
inline constexpr std::array<std::array<double, 3>, 3> kWeights = {{
    {(88 - 7 * kRoot6) / 360, (296 - 169 * kRoot6) / 1800, (-2 + 3 * kRoot6) / 225},
    {(296 + 169 * kRoot6) / 1800, (88 + 7 * kRoot6) / 360, (-2 - 3 * kRoot6) / 225},
    {(16 - kRoot6) / 36, (16 + kRoot6) / 36, 1.0 / 9},
}};
/// The real eigenvalue of the weights: (6 + ∛81 − ∛9) / 30.
inline constexpr double kGamma = 0.27488882959532694;
/// Weights of the stages' increments in the error estimate, times kGamma.
inline constexpr std::array<double, 3> kErrorWeights = {-(13 + 7 * kRoot6) / 3, (-13 + 7 * kRoot6) / 3,
                                                        -1.0 / 3};
inline constexpr int kMaxNewton = 10;  ///< limit of iterations; beyond it, the step is shortened
// Constants of takeCoarsely():
inline constexpr int kMaxTests = 64;          ///< limit of the tests of a change
inline constexpr double kPartCut = 0.25;      ///< factor of the part of a change that is tested next
inline constexpr double kPartGrowth = 16;     ///< factor of the part at the next change
inline constexpr double kSmallChange = 1e-6;  ///< relative change of the state at which the iteration ends

template <int N>
using Stages = std::array<StateVector<N>, 3>;

/// Evaluates the polynomial through (0, 0) and the stages' increments, `s` steps after the step's start.
template <int N>
StateVector<N> continued(const Stages<N>& stages, double s) {
  StateVector<N> value{};
  for (int i = 0; i < 3; ++i) {
    double weight = s / kNodes[i];
    for (int j = 0; j < 3; ++j) {
      if (j != i) weight *= (s - kNodes[j]) / (kNodes[i] - kNodes[j]);
    }
    for (int m = 0; m < N; ++m) value[m] += weight * stages[i][m];
  }
  return value;
}

template <int N, class System>
class Step {
 public:
  Step(const System& system, const IntegratorOptions& options, IntegratorCounters& counters)
      : m_system(system), m_options(options), m_counters(counters) {
    loosen(1);
  }

  /// Sets the tolerances to those of the options times `factor`.
  void loosen(double factor) {
    m_absolute = factor * m_options.stiff_absolute;
    m_relative = factor * m_options.stiff_relative;
    m_newton_limit = std::max(0x1p-48 / m_relative, 0.01);
  }

  /// Returns the derivative at the start of the step.
  const StateVector<N>& rate() const { return m_rate; }

  /// Evaluates the start. Returns a first step's length, in which the state changes by about a hundredth.
  double begin(double t, const StateVector<N>& y) {
    evaluate(t, y, m_rate);
    m_has_jacobian = false;
    const double speed = scaled(m_rate, y);
    return speed > 0 ? std::max(0.01 * scaled(y, y), 1.0) / speed : HUGE_VAL;
  }

  /// Finds the stages of a step from `y` at `t`. Returns false if Newton's iteration does not converge.
  bool solve(double t, const StateVector<N>& y, double length) {
    if (!m_has_jacobian) findJacobian(t, y);
    m_has_jacobian = true;
    m_increments = predicted(length);
    const bool has_converged = decompose(length) && iterate(t, y, length);
    if (!has_converged) m_last_length = 0;
    return has_converged;
  }

  /// The last resort, without error control: a step of backward Euler, by Newton's method. It is damped, so
  /// that it also finds the balance of a force that hardly changes except there. The state is not changed if
  /// the first increment points away from the derivative or is over √1.5 times as long as h·y′, because then
  /// the solution runs away faster than a step can resolve. Returns false if the matrix is singular.
  bool takeCoarsely(double t, StateVector<N>& y, double length) {
    const StateVector<N> start = y;
    evaluate(t, y, m_rate);
    double part = 1;
    int tests = 0;
    for (bool is_first = true; tests < kMaxTests; is_first = false) {
      findJacobian(t, y);
      auto& matrix = m_filter.matrix();
      for (int m = 0; m < N; ++m) {
        for (int n = 0; n < N; ++n) matrix[m][n] = (m == n) - length * m_jacobian[m][n];
      }
      if (!m_filter.decompose()) return !is_first;
      StateVector<N> change = missing(start, y, length);
      const double size = norm(change);
      if (is_first) {
        double along = 0;
        for (int m = 0; m < N; ++m) along += change[m] * m_rate[m];
        if (along < 0 || size * size > 1.5 * length * length * squareOf(m_rate)) return true;
      }
      // The part of the change that brings the solution nearer (Deuflhard's natural test of monotonicity).
      StateVector<N> next = y;
      double left = 0;
      for (part = std::min(1.0, kPartGrowth * part); tests++ < kMaxTests; part *= kPartCut) {
        for (int m = 0; m < N; ++m) next[m] = y[m] + part * change[m];
        evaluate(t, next, m_rate);
        left = norm(missing(start, next, length));
        if (left <= (1 - 0.5 * part) * size) break;
      }
      if (!(left <= (1 - 0.5 * part) * size)) return true;
      y = next;
      if (left <= kSmallChange * norm(y)) return true;
    }
    return true;
  }

  /// Returns the step's error over the allowed one; +∞ if the matrix is singular. `is_careful`: damps the
  /// error's stiff part again before rejection.
  double error(double t, const StateVector<N>& y, double length, bool is_careful) {
    auto& matrix = m_filter.matrix();
    for (int m = 0; m < N; ++m) {
      for (int n = 0; n < N; ++n) matrix[m][n] = (m == n) - length * kGamma * m_jacobian[m][n];
    }
    if (!m_filter.decompose()) return HUGE_VAL;
    const StateVector<N> estimate = filtered(m_rate, length);
    const double size = scaledError<N>(estimate, y, m_increments[2], m_absolute, m_relative);
    if (!is_careful || size < 1 || size > 1e100) return size;
    StateVector<N> at = y, rate;
    for (int m = 0; m < N; ++m) at[m] += estimate[m];
    evaluate(t, at, rate);
    return scaledError<N>(filtered(rate, length), y, m_increments[2], m_absolute, m_relative);
  }

  double nextFactor(double error) const {
    const double caution = 0.9 * (2 * kMaxNewton + 1) / (2 * kMaxNewton + m_iterations);
    return std::clamp(caution * df::math::exp(-0.25 * df::math::log(std::max(error, 1e-20))), 0.1, 8.0);
  }

  /// Accepts the step, which ends at `t`.
  void advance(double t, StateVector<N>& y, double length, bool is_last) {
    for (int m = 0; m < N; ++m) y[m] += m_increments[2][m];
    m_last_increments = m_increments;
    m_last_length = length;
    if (is_last) return;
    evaluate(t, y, m_rate);
    m_has_jacobian = false;
  }

 private:
  static double squareOf(const StateVector<N>& v) {
    double square = 0;
    for (const double x : v) square += x * x;
    return square;
  }
  static double norm(const StateVector<N>& v) { return std::sqrt(squareOf(v)); }

  // Returns the change of `y` by Newton's method for a step of backward Euler from `start`, with the
  // derivative m_rate at `y` and the decomposed matrix.
  StateVector<N> missing(const StateVector<N>& start, const StateVector<N>& y, double length) const {
    StateVector<N> change;
    for (int m = 0; m < N; ++m) change[m] = start[m] + length * m_rate[m] - y[m];
    m_filter.solve(change);
    return change;
  }

  void evaluate(double t, const StateVector<N>& y, StateVector<N>& rate) {
    m_system.derivative(t, y, rate);
    ++m_counters.evaluations;
  }

  double scaled(const StateVector<N>& change, const StateVector<N>& y) const {
    return scaledError<N>(change, y, StateVector<N>{}, m_absolute, m_relative);
  }

  // Computes the Jacobian by the system's own formula if there is one, otherwise by finite differences.
  void findJacobian(double t, const StateVector<N>& y) {
    ++m_counters.jacobians;
    if constexpr (requires { m_system.jacobian(t, y, m_jacobian); }) {
      if (m_system.jacobian(t, y, m_jacobian)) return;
    }
    const double floor = std::max(m_absolute / m_relative, 1e-8);
    StateVector<N> shifted = y, rate;
    for (int j = 0; j < N; ++j) {
      shifted[j] = y[j] + 0x1p-26 * std::max(std::fabs(y[j]), floor);
      const double shift = shifted[j] - y[j];
      evaluate(t, shifted, rate);
      for (int i = 0; i < N; ++i) m_jacobian[i][j] = (rate[i] - m_rate[i]) / shift;
      shifted[j] = y[j];
    }
  }

  // Predicts the stages by extrapolation of the last step's polynomial.
  Stages<N> predicted(double length) const {
    Stages<N> increments{};
    if (m_last_length == 0) return increments;
    for (int i = 0; i < 3; ++i) {
      increments[i] = continued<N>(m_last_increments, 1 + length / m_last_length * kNodes[i]);
      for (int m = 0; m < N; ++m) increments[i][m] -= m_last_increments[2][m];
    }
    return increments;
  }

  // Decomposes the matrix I − h·A⊗J.
  bool decompose(double length) {
    auto& matrix = m_newton.matrix();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int m = 0; m < N; ++m) {
          for (int n = 0; n < N; ++n) {
            matrix[i * N + m][j * N + n] = (i == j && m == n) - length * kWeights[i][j] * m_jacobian[m][n];
          }
        }
      }
    }
    return m_newton.decompose();
  }

  bool iterate(double t, const StateVector<N>& y, double length) {
    double last_size = 0;
    for (m_iterations = 1; m_iterations <= kMaxNewton; ++m_iterations) {
      const double size = improve(t, y, length);
      if (!(size < 1e100)) return false;
      if (size <= 1e-3 * m_newton_limit) return true;
      if (m_iterations > 1) {
        const double contraction = size / last_size;
        // When rounding prevents further convergence, a small last change is accepted.
        if (contraction >= 1) return contraction < 2 && size <= m_newton_limit;
        const double left = contraction / (1 - contraction) * size;
        if (left <= m_newton_limit) return true;
        const int more = kMaxNewton - 1 - m_iterations;
        if (left * df::math::exp(more * df::math::log(contraction)) > m_newton_limit) return false;
      }
      last_size = size;
    }
    return false;
  }

  // Does one iteration. Returns the size of the change.
  double improve(double t, const StateVector<N>& y, double length) {
    Stages<N> rates;
    for (int i = 0; i < 3; ++i) {
      StateVector<N> at = y;
      for (int m = 0; m < N; ++m) at[m] += m_increments[i][m];
      evaluate(t + length * kNodes[i], at, rates[i]);
    }
    StateVector<3 * N> change;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < N; ++m) {
        const double sum =
            kWeights[i][0] * rates[0][m] + kWeights[i][1] * rates[1][m] + kWeights[i][2] * rates[2][m];
        change[i * N + m] = length * sum - m_increments[i][m];
      }
    }
    m_newton.solve(change);
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      StateVector<N> part;
      for (int m = 0; m < N; ++m) {
        part[m] = change[i * N + m];
        m_increments[i][m] += part[m];
      }
      size = std::max(size, scaled(part, y));
    }
    return size;
  }

  // Returns the error estimate with its stiff part damped. `rate` is the derivative at the start; to damp
  // again, that at the start plus the first estimate.
  StateVector<N> filtered(const StateVector<N>& rate, double length) const {
    StateVector<N> estimate;
    for (int m = 0; m < N; ++m) {
      double sum = length * rate[m];
      for (int i = 0; i < 3; ++i) sum += kErrorWeights[i] * m_increments[i][m];
      estimate[m] = kGamma * sum;
    }
    m_filter.solve(estimate);
    return estimate;
  }

  const System& m_system;
  const IntegratorOptions& m_options;
  IntegratorCounters& m_counters;
  double m_absolute = 0;
  double m_relative = 0;
  double m_newton_limit = 0;  // part of the allowed error for the iteration; at least rounding
  StateVector<N> m_rate{};
  StateMatrix<N> m_jacobian{};
  bool m_has_jacobian = false;
  DenseSolve<3 * N> m_newton;
  DenseSolve<N> m_filter;
  Stages<N> m_increments{};
  int m_iterations = 0;
  Stages<N> m_last_increments{};  // increments of the previous accepted step, used for the prediction
  double m_last_length = 0;
};

}  // namespace radau

/// Integrates from `t` to `end` >= t. On return `t` and `y` are the state reached: that at `end` if the
/// status is kDone. The tolerances grow by the factor `loosening` after each third of the allowed steps.
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

/// Integrates in this many equal steps of backward Euler, which damp. The result is bounded for any
/// stiffness, but there is no error control.
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
