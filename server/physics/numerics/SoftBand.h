// A symmetric positive definite system whose entries lie near the diagonal: Cholesky without roots.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "physics/geometry/Index.h"

namespace naiad::physics {

/// LDLᵀ within a band: n · band² / 2 multiplications to decompose, 2 · n · band to solve. Allocates in
/// resize() alone.
class SoftBand {
 public:
  /// Entries (i, j) with |i − j| <= band may differ from zero.
  void resize(int size, int band) {
    m_size = size;
    m_band = band;
    m_entries.assign(at(size) * at(band + 1), 0);
  }
  int size() const { return m_size; }
  void clear() { std::fill(m_entries.begin(), m_entries.end(), 0); }
  /// i >= j.
  double& entry(int i, int j) { return m_entries[at(j) * at(m_band + 1) + at(i - j)]; }

  /// False if a pivot is not positive (or not a number); then solve() must not be called.
  bool decompose() {
    for (int j = 0; j < m_size; ++j) {
      double* row = &entry(j, j);
      if (!(row[0] > 0 && row[0] < 1e300)) return false;
      const double inverse = row[0] = 1 / row[0];
      const int width = std::min(m_band, m_size - 1 - j);
      for (int i = 1; i <= width; ++i) {
        const double factor = row[i] * inverse;
        if (factor == 0) continue;
        double* below = &entry(j + i, j + i);
        for (int k = i; k <= width; ++k) below[k - i] -= factor * row[k];
      }
      for (int i = 1; i <= width; ++i) row[i] *= inverse;
    }
    return true;
  }

  /// Replaces the right-hand side by the solution.
  void solve(double* b) const {
    for (int j = 0; j < m_size; ++j) {
      const double* row = &m_entries[at(j) * at(m_band + 1)];
      const int width = std::min(m_band, m_size - 1 - j);
      const double above = b[j];
      if (above != 0) {
        for (int k = 1; k <= width; ++k) b[j + k] -= row[k] * above;
      }
      b[j] = above * row[0];
    }
    for (int j = m_size - 1; j >= 0; --j) {
      const double* row = &m_entries[at(j) * at(m_band + 1)];
      const int width = std::min(m_band, m_size - 1 - j);
      for (int k = 1; k <= width; ++k) b[j] -= row[k] * b[j + k];
    }
  }

 private:
  int m_size = 0;
  int m_band = 0;
  std::vector<double> m_entries;  // column by column, from the diagonal down; decomposed: L, and 1/D
};

}  // namespace naiad::physics
