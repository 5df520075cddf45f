// A small dense system of linear equations, by elimination with row pivots.
#pragma once

#include <array>
#include <cmath>
#include <utility>

namespace naiad::physics {

/// Fill matrix(), call decompose() once, then solve() any number of times. This class does not allocate.
template <int N>
class DenseSolve {
 public:
  std::array<std::array<double, N>, N>& matrix() { return m_rows; }

  /// Returns false if the matrix is singular or not finite; then solve() must not be called.
  bool decompose() {
    for (int k = 0; k < N; ++k) {
      int pivot = k;
      for (int i = k + 1; i < N; ++i) {
        if (std::fabs(m_rows[i][k]) > std::fabs(m_rows[pivot][k])) pivot = i;
      }
      m_pivot[k] = pivot;
      if (pivot != k) std::swap(m_rows[k], m_rows[pivot]);
      const double top = m_rows[k][k];
      if (!(std::fabs(top) > 0 && std::fabs(top) < HUGE_VAL)) return false;
      for (int i = k + 1; i < N; ++i) {
        const double factor = m_rows[i][k] /= top;
        if (factor == 0) continue;
        for (int j = k + 1; j < N; ++j) m_rows[i][j] -= factor * m_rows[k][j];
      }
    }
    return true;
  }

  /// Replaces the right-hand side by the solution.
  void solve(std::array<double, N>& b) const {
    for (int k = 0; k < N; ++k) {
      if (m_pivot[k] != k) std::swap(b[k], b[m_pivot[k]]);
    }
    for (int i = 1; i < N; ++i) {
      for (int j = 0; j < i; ++j) b[i] -= m_rows[i][j] * b[j];
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int j = i + 1; j < N; ++j) b[i] -= m_rows[i][j] * b[j];
      b[i] /= m_rows[i][i];
    }
  }

 private:
  std::array<std::array<double, N>, N> m_rows{};
  std::array<int, N> m_pivot{};
};

}  // namespace naiad::physics
