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
    m_stride = band + 1 + (band < kWideBand ? 0 : kPadding);
    m_entries.assign(at(size) * at(m_stride), 0);
  }
  int size() const { return m_size; }
  void clear() { std::fill(m_entries.begin(), m_entries.end(), 0); }
  /// i >= j.
  double& entry(int i, int j) { return m_entries[at(j) * at(m_stride) + at(i - j)]; }

  /// False if a pivot is not positive (or not a number); then solve() must not be called.
  bool decompose();

  /// Replaces the right-hand side by the solution.
  void solve(double* b) const {
    for (int j = 0; j < m_size; ++j) {
      const double* row = &m_entries[at(j) * at(m_stride)];
      const int width = widthOf(j);
      const double above = b[j];
      if (above != 0) {
        for (int k = 1; k <= width; ++k) b[j + k] -= row[k] * above;
      }
      b[j] = above * row[0];
    }
    for (int j = m_size - 1; j >= 0; --j) {
      const double* row = &m_entries[at(j) * at(m_stride)];
      const int width = widthOf(j);
      for (int k = 1; k <= width; ++k) b[j] -= row[k] * b[j + k];
    }
  }

 private:
  // Pivots that are eliminated from what is right of them at once, so that it is read and written once for
  // all of them. In a narrow band there is too little to gain.
  static constexpr int kPivots = 4;
  static constexpr int kWideBand = 12;
  static constexpr int kPadding = 7;  // zeros below a column: what four pivots and whole vectors go beyond it

  int widthOf(int j) const { return std::min(m_band, m_size - 1 - j); }
  bool invertPivot(int j);
  void eliminate(int j, int first, int last);
  void eliminateFour(int j);
  void scale(int j);

  int m_size = 0;
  int m_band = 0;
  int m_stride = 0;               // from column to column
  std::vector<double> m_entries;  // column by column, from the diagonal down; decomposed: L, and 1/D
};

}  // namespace naiad::physics
