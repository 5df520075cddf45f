// Small dense systems of linear equations.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "Real.h"

namespace lab {

template <class Real, int N>
using Matrix = std::array<std::array<Real, static_cast<std::size_t>(N)>, static_cast<std::size_t>(N)>;

template <class Real, int N>
using Column = std::array<Real, static_cast<std::size_t>(N)>;

/// Replaces `column` by the solution, by Gaussian elimination with partial pivoting; for a singular matrix,
/// by infinities.
template <class Real, std::size_t N>
void solveInPlace(std::array<std::array<Real, N>, N> matrix, std::array<Real, N>& column) {
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < N; ++row) {
      if (abs(matrix[row][k]) > abs(matrix[pivot][k])) pivot = row;
    }
    std::swap(matrix[k], matrix[pivot]);
    std::swap(column[k], column[pivot]);
    for (std::size_t row = k + 1; row < N; ++row) {
      const Real factor = matrix[row][k] / matrix[k][k];
      for (std::size_t i = k; i < N; ++i) matrix[row][i] -= factor * matrix[k][i];
      column[row] -= factor * column[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t i = k + 1; i < N; ++i) column[k] -= matrix[k][i] * column[i];
    column[k] /= matrix[k][k];
  }
}

/// Returns ∂f/∂y of a System, exact to rounding, by dual numbers: jacobian[row][column].
template <class System>
Matrix<double, System::kDimension> jacobianOf(const System& system, double t, const double* y) {
  constexpr int kN = System::kDimension;
  Column<Dual<kN>, kN> at;
  Column<Dual<kN>, kN> rates;
  for (int i = 0; i < kN; ++i) at[static_cast<std::size_t>(i)] = Dual<kN>::variable(y[i], i);
  system.rate(Dual<kN>(t), at.data(), rates.data());
  Matrix<double, kN> jacobian;
  for (std::size_t row = 0; row < kN; ++row) jacobian[row] = rates[row].slope;
  return jacobian;
}

}  // namespace lab
