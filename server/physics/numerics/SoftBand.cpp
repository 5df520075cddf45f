#include "physics/numerics/SoftBand.h"

#include <array>
#include <cstring>

namespace naiad::physics {

namespace {

// Vectors of doubles. The compiler's operators round each element once, so all processors give equal bits.
constexpr int kDoubles = 4;
using Doubles = double __attribute__((vector_size(kDoubles * sizeof(double))));

}  // namespace

// Both loops apply the same operations to an entry, in the same order.
bool SoftBand::decompose() {
  int j = 0;
  for (; m_band >= kWideBand && j + kPivots <= m_size; j += kPivots) {
    for (int p = j; p < j + kPivots; ++p) {
      if (!invertPivot(p)) return false;
      eliminate(p, p + 1, j + kPivots - 1);
    }
    eliminateFour(j);
    for (int p = j; p < j + kPivots; ++p) scale(p);
  }
  for (; j < m_size; ++j) {
    if (!invertPivot(j)) return false;
    eliminate(j, j + 1, m_size - 1);
    scale(j);
  }
  return true;
}

bool SoftBand::invertPivot(int j) {
  double& pivot = entry(j, j);
  if (!(pivot > 0 && pivot < 1e300)) return false;
  pivot = 1 / pivot;
  return true;
}

// Eliminates column j from the columns `first` to `last` to its right.
void SoftBand::eliminate(int j, int first, int last) {
  const double* const row = &entry(j, j);
  const int width = widthOf(j);
  for (int i = first - j; i <= std::min(width, last - j); ++i) {
    const double factor = row[i] * row[0];
    if (factor == 0) continue;
    double* const below = &entry(j + i, j + i);
    for (int k = i; k <= width; ++k) below[k - i] -= factor * row[k];
  }
}

// Eliminates columns j to j + 3 from all columns to the right of them. An entry that one of the four columns
// does not reach is zero there.
void SoftBand::eliminateFour(int j) {
  const int end = j + kPivots + m_band;  // end of the rows that the four columns reach
  for (int c = j + kPivots; c < std::min(end, m_size); ++c) {
    std::array<const double*, kPivots> from;  // by column: the entries in row c and below
    std::array<double, kPivots> factors;
    for (int p = 0; p < kPivots; ++p) {
      const double* const column = &entry(j + p, j + p);
      from[at(p)] = column + (c - j - p);
      factors[at(p)] = *from[at(p)] * *column;
    }
    double* const below = &entry(c, c);
    for (int m = 0; m < end - c; m += kDoubles) {
      Doubles sum;
      std::memcpy(&sum, below + m, sizeof sum);
      for (std::size_t p = 0; p < kPivots; ++p) {
        Doubles entries;
        std::memcpy(&entries, from[p] + m, sizeof entries);
        sum -= factors[p] * entries;
      }
      std::memcpy(below + m, &sum, sizeof sum);
    }
  }
}

void SoftBand::scale(int j) {
  double* const row = &entry(j, j);
  const int width = widthOf(j);
  for (int i = 1; i <= width; ++i) row[i] *= row[0];
}

}  // namespace naiad::physics
