// A symmetric positive definite band matrix: Cholesky factorisation without square roots.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "physics/geometry/Index.h"

namespace naiad::physics {

/// LDLᵀ of a band: n·band²/2 multiplications to decompose, 2·n·band to solve. Only resize() allocates.
class SoftBand {
 public:
  /// Sets the size; only entries (i, j) with |i − j| <= band may differ from zero.
  void resize(int size, int band) {
    m_size = size;
    m_band = band;
    m_stride = band + 1 + (band < kWideBand ? 0 : kPadding);
    m_entries.assign(at(size) * at(m_stride), 0);
  }
  int size() const { return m_size; }
  void clear() { std::fill(m_entries.begin(), m_entries.end(), 0); }
  /// Returns the entry (i, j) for i >= j.
  double& entry(int i, int j) { return m_entries[at(j) * at(m_stride) + at(i - j)]; }

  /// Returns false if a pivot is not positive, 1e300 or more, or NaN; then solve() must not be called.
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
  // Number of pivots that are eliminated from the columns to the right in one pass, so that these columns are
  // read and written only once. This is not worthwhile if the band is narrower than kWideBand.
  static constexpr int kPivots = 4;
  static constexpr int kWideBand = 12;
  static constexpr int kPadding = 7;  // zeros after a column, for reads beyond its end

  int widthOf(int j) const { return std::min(m_band, m_size - 1 - j); }
  bool invertPivot(int j);
  void eliminate(int j, int first, int last);
  void eliminateFour(int j);
  void scale(int j);

  int m_size = 0;
  int m_band = 0;
  int m_stride = 0;               // distance of two columns in m_entries
  std::vector<double> m_entries;  // by column, from the diagonal down; after decompose(): L and 1/D
};

}  // namespace naiad::physics
