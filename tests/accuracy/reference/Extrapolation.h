// Reference solutions in quad precision by extrapolation: a step is computed with 1, 2, 3 … parts, and a
// polynomial extrapolates to infinitely many (Hairer & Wanner, Solving ODEs I, II.9, and II, IV.9).
#pragma once

#include <stdexcept>
#include <vector>

#include "Linear.h"

namespace lab {

enum class Stiffness {
  NONE,   ///< the modified midpoint rule, order 16
  STIFF,  ///< the linearly implicit Euler method, order 10; the equations must not depend on t
};

template <class System>
class Extrapolation {
 public:
  using State = std::array<Quad, static_cast<std::size_t>(System::kDimension)>;

  Extrapolation(const System& system, Stiffness stiffness)
      : m_system(system), m_stiff(stiffness == Stiffness::STIFF) {
    const auto start = m_system.start();
    for (std::size_t i = 0; i < kN; ++i) m_y[i] = start[i];
  }

  /// Advances to time `end`.
  void advance(Quad end) {
    while (m_t < end) {
      if (++m_steps > kMaxSteps) throw std::runtime_error("extrapolation takes too many steps");
      const bool last = m_t + m_h >= end;
      const Quad h = last ? end - m_t : m_h;
      State next;
      const Quad error = attempt(h, next);
      // The error of a step is proportional to this power of its length.
      const double power = m_stiff ? kColumns : 2 * kColumns - 1;
      const Quad ratio = error > 0 ? powq(error / kTolerance, -1 / Quad(power)) : Quad(4);
      const Quad factor = ratio < 0.1 ? Quad(0.1) : ratio > 4 ? Quad(4) : ratio;
      if (error <= kTolerance) {
        m_y = next;
        m_t = last ? end : m_t + h;
        // The last step was shortened to hit the end, so it may only reduce the step length, not raise it.
        const Quad longer = h * factor * 0.9;
        if (!last || factor < 1 || longer > m_h) m_h = longer;
      } else {
        m_h = h * (factor < 1 ? factor : Quad(0.5)) * 0.9;
      }
    }
  }

  const State& state() const { return m_y; }

 private:
  static constexpr std::size_t kN = System::kDimension;
  static constexpr int kColumns = 10;
  static constexpr double kTolerance = 1e-16;
  static constexpr double kNearlyZero = 1e-8;
  static constexpr long kMaxSteps = 1000000;

  static Quad parts(int row, bool stiff) { return stiff ? row + 1 : 2 * (row + 1); }

  // Tries a step of length h and returns its error relative to the largest value of each component so far. A
  // component that is still nearly 0 compared with the others counts as rounding.
  Quad attempt(Quad h, State& next) {
    if (m_stiff) findJacobian();
    std::vector<State> column;  // the last row of the tableau
    Quad error = 0;
    for (int row = 0; row < kColumns; ++row) {
      std::vector<State> current{m_stiff ? implicitEuler(h, row + 1) : midpoint(h, 2 * (row + 1))};
      for (int k = 1; k <= row; ++k) {
        const Quad ratio = parts(row, m_stiff) / parts(row - k, m_stiff);
        const Quad divisor = (m_stiff ? ratio : ratio * ratio) - 1;
        State better = current.back();
        for (std::size_t i = 0; i < kN; ++i) {
          better[i] += (current.back()[i] - column[static_cast<std::size_t>(k - 1)][i]) / divisor;
        }
        current.push_back(better);
      }
      column = current;
    }
    next = column.back();
    Quad largest = 0;
    for (std::size_t i = 0; i < kN; ++i) {
      if (!(abs(next[i]) < Quad(1e300))) return Quad(1e300);
      m_scale[i] = std::max(m_scale[i], abs(m_y[i]));
      largest = std::max(largest, std::max(m_scale[i], abs(next[i])));
    }
    for (std::size_t i = 0; i < kN; ++i) {
      const Quad scale = std::max(std::max(m_scale[i], abs(next[i])), kNearlyZero * largest);
      error = std::max(error, abs(next[i] - column[column.size() - 2][i]) / scale);
    }
    return error;
  }

  State rate(Quad t, const State& y) const {
    State rates;
    m_system.rate(t, y.data(), rates.data());
    return rates;
  }

  State midpoint(Quad h, int steps) const {
    const Quad part = h / steps;
    State before = m_y;
    State now = m_y;
    const State first = rate(m_t, m_y);
    for (std::size_t i = 0; i < kN; ++i) now[i] += part * first[i];
    for (int step = 1; step < steps; ++step) {
      const State rates = rate(m_t + part * step, now);
      for (std::size_t i = 0; i < kN; ++i) {
        const Quad after = before[i] + 2 * part * rates[i];
        before[i] = now[i];
        now[i] = after;
      }
    }
    const State rates = rate(m_t + h, now);
    for (std::size_t i = 0; i < kN; ++i) now[i] = (now[i] + before[i] + part * rates[i]) / 2;
    return now;
  }

  State implicitEuler(Quad h, int steps) const {
    const Quad part = h / steps;
    Matrix<Quad, System::kDimension> matrix;
    for (std::size_t row = 0; row < kN; ++row) {
      for (std::size_t i = 0; i < kN; ++i) matrix[row][i] = -part * m_jacobian[row][i];
      matrix[row][row] += 1;
    }
    State y = m_y;
    for (int step = 0; step < steps; ++step) {
      State change = rate(m_t, y);
      for (Quad& value : change) value *= part;
      solveInPlace(matrix, change);
      for (std::size_t i = 0; i < kN; ++i) y[i] += change[i];
    }
    return y;
  }

  void findJacobian() {
    std::array<double, kN> at;
    for (std::size_t i = 0; i < kN; ++i) at[i] = static_cast<double>(m_y[i]);
    const auto jacobian = jacobianOf(m_system, static_cast<double>(m_t), at.data());
    for (std::size_t row = 0; row < kN; ++row) {
      for (std::size_t i = 0; i < kN; ++i) m_jacobian[row][i] = jacobian[row][i];
    }
  }

  System m_system;
  bool m_stiff;
  Quad m_t = 0;
  Quad m_h = 1e-6;
  State m_y;
  State m_scale{};
  Matrix<Quad, System::kDimension> m_jacobian{};
  long m_steps = 0;
};

/// Returns the states at the ends of ticks 0 … `ticks`, rounded to double.
template <class System>
std::vector<std::vector<double>> solveByExtrapolation(const System& system, double tick, int ticks,
                                                      Stiffness stiffness) {
  Extrapolation<System> solver(system, stiffness);
  std::vector<std::vector<double>> trajectory{system.start()};
  for (int i = 1; i <= ticks; ++i) {
    solver.advance(Quad(tick) * i);
    std::vector<double> state;
    for (const Quad& value : solver.state()) state.push_back(static_cast<double>(value));
    trajectory.push_back(state);
  }
  return trajectory;
}

}  // namespace lab
