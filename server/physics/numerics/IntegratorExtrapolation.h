// Gragg's midpoint rule with Bulirsch–Stoer extrapolation: explicit, error-controlled, of variable order.
//
// A step of length H is computed with 2, 4, 6 … sub-steps by the modified midpoint rule, whose error has only
// even powers of the sub-step. A polynomial in the square of the sub-step is extrapolated to zero (Aitken and
// Neville; Hairer, Nørsett and Wanner, "Solving Ordinary Differential Equations I", II.9). Column k has order
// 2k. Order and step are chosen for the least work per unit of time.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/numerics/Integrator.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

/// Returns the largest ratio of a component of `error` to the allowed error, for a step from `y` to `y` +
/// `increment`; +∞ if that is NaN or above 1e300.
template <int N>
double scaledError(const StateVector<N>& error, const StateVector<N>& y, const StateVector<N>& increment,
                   double absolute, double relative) {
  double largest = 0;
  for (int i = 0; i < N; ++i) {
    const double size = std::max(std::fabs(y[i]), std::fabs(y[i] + increment[i]));
    const double scaled = std::fabs(error[i]) / (absolute + relative * size);
    if (!(scaled <= 1e300)) return HUGE_VAL;
    largest = std::max(largest, scaled);
  }
  return largest;
}

/// True if all components are finite and small enough for further calculation.
template <int N>
bool isUsable(const StateVector<N>& y) {
  return std::all_of(y.begin(), y.end(), [](double value) { return std::fabs(value) <= 1e300; });
}

namespace extrapolation {

inline constexpr int kColumns = 8;  ///< maximum number of columns of the table, which gives order 16
inline constexpr int kMaxSubsteps = 2 * kColumns;

/// Row i (with 2(i + 1) sub-steps) is corrected in column j by its difference to the row before, times 1 /
/// ((n_i / n_(i−1−j))² − 1).
inline constexpr auto kWeights = [] {
  std::array<std::array<double, kColumns>, kColumns> weights{};
  for (int i = 1; i < kColumns; ++i) {
    for (int j = 0; j < i; ++j) {
      const double far = i + 1, near = i - j;
      weights[i][j] = near * near / (far * far - near * near);
    }
  }
  return weights;
}();

/// Returns the evaluations for the first `columns` columns together, including the one at the start.
constexpr int evaluationsOf(int columns) {
  return 1 + columns * columns;  // 1 + Σ (2j − 1)
}

/// Returns the factor for the next step's length, if this column's error was `error` times the allowed one.
inline double stepFactor(double error, int columns) {
  const double power = 1.0 / (2 * columns - 1);
  const double factor = 0.94 * df::math::exp(power * df::math::log(0.65 / std::max(error, 1e-30)));
  return std::clamp(factor, 0.02, 6.0);
}

/// Returns the factor by which later columns can still reduce the error: column j by about (2j)².
constexpr double hopeAfter(int columns) {
  double hope = 1;
  for (int j = columns + 1; j <= kColumns; ++j) hope *= 4.0 * j * j;
  return hope;
}

/// One step: the table's rows, their extrapolation, and the choice of the next step.
template <int N, class System>
class Step {
 public:
  Step(const System& system, const IntegratorOptions& options) : m_system(system), m_options(options) {}

  /// Steps from `y` at `t`, with derivative `rate`, by `length`. True if a column was accurate enough.
  bool take(double t, const StateVector<N>& y, const StateVector<N>& rate, double length) {
    for (m_columns = 0; m_columns < kColumns;) {
      StateVector<N> error{}, last = midpoints(t, y, rate, length, 2 * (m_columns + 1));
      for (int j = 0; j < m_columns; ++j) {
        for (int i = 0; i < N; ++i) {
          error[i] = kWeights[m_columns][j] * (last[i] - m_row[j][i]);
          m_row[j][i] = std::exchange(last[i], last[i] + error[i]);
        }
      }
      m_row[m_columns++] = last;
      if (m_columns == 1) continue;
      const double scaled = scaledError<N>(error, y, last, m_options.absolute, m_options.relative);
      m_errors[m_columns] = scaled;
      if (scaled <= 1) return true;
      if (m_columns >= 4 && scaled > hopeAfter(m_columns)) return false;
    }
    return false;
  }

  /// True if the derivative jumps near an end of the step. `rate` and `rate_at_end` are the derivatives at
  /// its ends. The midpoint rule hardly uses the ends, so its rows would agree although a force was switched
  /// on or off there. Compares the second differences at the ends with those farther inside (or, with four
  /// sub-steps, with each other), taken about odd sub-steps because the rule's own error alternates.
  bool missesJump(const StateVector<N>& y, const StateVector<N>& rate, const StateVector<N>& rate_at_end,
                  double length) const {
    const int n = 2 * m_columns;
    const auto bend = [&](const StateVector<N>& a, const StateVector<N>& b, const StateVector<N>& c) {
      StateVector<N> difference;
      for (int i = 0; i < N; ++i) difference[i] = length / n * (a[i] - 2 * b[i] + c[i]);
      return scaledError<N>(difference, y, increment(), m_options.absolute, m_options.relative);
    };
    const double first = bend(rate, m_slope[1], m_slope[2]);
    const double last = bend(rate_at_end, m_slope[n - 1], m_slope[n - 2]);
    const double larger = std::max(first, last);
    if (larger <= 1) return false;
    if (n == 4) return larger > 16 * std::min(first, last);
    return larger > 16 * std::max(bend(m_slope[2], m_slope[3], m_slope[4]),
                                  bend(m_slope[n - 4], m_slope[n - 3], m_slope[n - 2]));
  }

  const StateVector<N>& increment() const { return m_row[m_columns - 1]; }
  int columns() const { return m_columns; }
  /// Returns the number of evaluations of the derivative, without the one at the start.
  int evaluations() const { return evaluationsOf(m_columns) - 1; }

  /// Returns the length of the next step relative to this one, by the column with the least cost per unit of
  /// time. If the step succeeded at the first attempt, `may_grow` allows one more column.
  double nextFactor(bool may_grow) const {
    int best = 2;
    double factor = stepFactor(m_errors[2], 2);
    for (int j = 3; j <= m_columns; ++j) {
      const double other = stepFactor(m_errors[j], j);
      if (evaluationsOf(j) * factor >= evaluationsOf(best) * other) continue;
      best = j;
      factor = other;
    }
    if (!may_grow || best != m_columns || m_columns == kColumns) return factor;
    return factor * evaluationsOf(best + 1) / evaluationsOf(best);
  }

 private:
  // Returns the increment of the modified midpoint rule with n sub-steps, n even.
  StateVector<N> midpoints(double t, const StateVector<N>& y, const StateVector<N>& rate, double length,
                           int n) {
    const double h = length / n;
    StateVector<N> before{}, now, at;
    for (int i = 0; i < N; ++i) now[i] = h * rate[i];
    for (int m = 1; m < n; ++m) {
      for (int i = 0; i < N; ++i) at[i] = y[i] + now[i];
      m_system.derivative(t + m * h, at, m_slope[m]);
      for (int i = 0; i < N; ++i) before[i] = std::exchange(now[i], before[i] + 2 * h * m_slope[m][i]);
    }
    return now;
  }

  const System& m_system;
  const IntegratorOptions& m_options;
  int m_columns = 0;
  std::array<StateVector<N>, kColumns> m_row;        // last row of the table: the step's increment by column
  std::array<StateVector<N>, kMaxSubsteps> m_slope;  // derivatives of the last row at its inner sub-steps
  std::array<double, kColumns + 1> m_errors{};
};

}  // namespace extrapolation

/// Integrates from `t` to `end` >= t. On return `t` and `y` are the state reached: that at `end` if the
/// status is kDone. With `patience` > 0 it also fails if, at the speed of the last step, the total would
/// exceed `patience` times the limit of evaluations.
template <int N, class System>
IntegratorStatus integrateByExtrapolation(const System& system, double& t, double end, StateVector<N>& y,
                                          const IntegratorOptions& options, IntegratorCounters& counters,
                                          int patience) {
  extrapolation::Step<N, System> step(system, options);
  StateVector<N> rate, rate_at_end;
  std::int64_t evaluations = 0;
  const auto evaluate = [&](double at, const StateVector<N>& state, StateVector<N>& out) {
    system.derivative(at, state, out);
    ++evaluations;
    ++counters.evaluations;
    return isUsable<N>(out);
  };
  if (!evaluate(t, y, rate)) return IntegratorStatus::kNotFinite;
  double length = end - t;
  bool was_rejected = false;
  while (t < end) {
    const double whole = end - t;
    if (length > 0.999 * whole) length = whole;
    if (t + length == t) return IntegratorStatus::kNoProgress;

    bool is_accepted = step.take(t, y, rate, length), has_jump = false;
    evaluations += step.evaluations();
    counters.evaluations += step.evaluations();
    if (is_accepted) {
      const double at_end = length == whole ? end : t + length;
      StateVector<N> next = y;
      for (int i = 0; i < N; ++i) next[i] += step.increment()[i];
      has_jump = !evaluate(at_end, next, rate_at_end) || step.missesJump(y, rate, rate_at_end, length);
      is_accepted = !has_jump;
      if (is_accepted) {
        t = at_end;
        y = next;
        rate = rate_at_end;
        ++counters.steps;
        if (t == end) break;
      }
    }
    if (is_accepted) {
      length *= step.nextFactor(!was_rejected);
    } else {
      length *= has_jump ? 0.2 : std::min(step.nextFactor(false), 0.7);
      ++counters.rejected;
    }
    was_rejected = !is_accepted;

    // Estimates what remains at this speed: stiffness makes steps shorter than the accuracy requires.
    const double ahead = (end - t) / length * extrapolation::evaluationsOf(step.columns());
    const bool is_slow = patience > 0 && evaluations > 150 && is_accepted &&
                         ahead > static_cast<double>(patience) * options.max_evaluations;
    if (is_slow || evaluations > options.max_evaluations) return IntegratorStatus::kTooManySteps;
  }
  return IntegratorStatus::kDone;
}

}  // namespace naiad::physics
