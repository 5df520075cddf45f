// Reference solutions in quadruple precision for tests: slow and simple, and independent of the tested code.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tests/support/Quad.h"

namespace naiad::physics {

inline Quad q(double x) {
  return static_cast<Quad>(x);
}

template <int N>
using QuadVector = std::array<Quad, N>;

template <int N>
using QuadSystem = std::function<QuadVector<N>(Quad t, const QuadVector<N>& y)>;

/// Solves a smooth system by the classical Runge-Kutta method with `steps`, 2·steps, … steps, extrapolated
/// `levels` times. The error contains all powers of the step length from the fourth on.
template <int N>
QuadVector<N> quadSolve(const QuadSystem<N>& f, Quad t0, Quad t1, const QuadVector<N>& start, int steps,
                        int levels = 5) {
  std::vector<QuadVector<N>> row;
  for (int level = 0; level < levels; ++level) {
    const int count = steps << level;
    const Quad h = (t1 - t0) / count;
    QuadVector<N> y = start;
    const auto moved = [&](const QuadVector<N>& by, Quad s) {
      QuadVector<N> z = y;
      for (int i = 0; i < N; ++i) z[i] += s * by[i];
      return z;
    };
    for (int n = 0; n < count; ++n) {
      const Quad t = t0 + n * h;
      const auto k1 = f(t, y);
      const auto k2 = f(t + h / 2, moved(k1, h / 2));
      const auto k3 = f(t + h / 2, moved(k2, h / 2));
      const auto k4 = f(t + h, moved(k3, h));
      for (int i = 0; i < N; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    Quad factor = 16;
    for (auto& before : row) {  // row: the results of level − 1, extrapolated 0, 1, 2, … times
      const QuadVector<N> better = [&] {
        QuadVector<N> z = y;
        for (int i = 0; i < N; ++i) z[i] += (y[i] - before[i]) / (factor - 1);
        return z;
      }();
      before = y;
      y = better;
      factor *= 2;
    }
    row.push_back(y);
  }
  return row.back();
}

/// Solves a stiff system by the extrapolated linearly implicit Euler method (Deuflhard 1985). The error
/// estimate determines the step length; the Jacobian is computed by differences in quadruple precision.
template <int N>
QuadVector<N> quadSolveStiff(const QuadSystem<N>& f, Quad t, Quad end, QuadVector<N> y, Quad tolerance,
                             Quad floor) {
  constexpr int kColumns = 10;
  Quad step = (end - t) * 1e-10;
  while (t < end) {
    if (t + step > end) step = end - t;
    std::array<QuadVector<N>, N> jacobian;
    const auto rate = f(t, y);
    for (int j = 0; j < N; ++j) {
      QuadVector<N> z = y;
      const Quad shift = static_cast<Quad>(1e-16) * (fabsq(y[j]) > floor ? fabsq(y[j]) : floor);
      z[j] += shift;
      const auto other = f(t, z);
      for (int i = 0; i < N; ++i) jacobian[i][j] = (other[i] - rate[i]) / shift;
    }
    std::vector<QuadVector<N>> row;
    Quad error = 1e30;
    for (int k = 0; k < kColumns && error > 1; ++k) {
      const int count = k + 2;
      const Quad h = step / count;
      std::array<QuadVector<N>, N> inverse{}, a{};  // (1 − hJ)⁻¹ by Gauss-Jordan elimination
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < N; ++j) a[i][j] = (i == j) - h * jacobian[i][j];
        inverse[i][i] = 1;
      }
      for (int c = 0; c < N; ++c) {
        int pivot = c;
        for (int i = c; i < N; ++i) {
          if (fabsq(a[i][c]) > fabsq(a[pivot][c])) pivot = i;
        }
        std::swap(a[c], a[pivot]);
        std::swap(inverse[c], inverse[pivot]);
        const Quad top = a[c][c];
        for (int j = 0; j < N; ++j) a[c][j] /= top, inverse[c][j] /= top;
        for (int i = 0; i < N; ++i) {
          if (i == c) continue;
          const Quad factor = a[i][c];
          for (int j = 0; j < N; ++j) a[i][j] -= factor * a[c][j], inverse[i][j] -= factor * inverse[c][j];
        }
      }
      QuadVector<N> z = y;
      for (int n = 0; n < count; ++n) {  // valid only for autonomous systems
        const auto r = f(t, z);
        for (int i = 0; i < N; ++i) {
          for (int j = 0; j < N; ++j) z[i] += h * inverse[i][j] * r[j];
        }
      }
      QuadVector<N> last = z;
      for (int j = 0; j < k; ++j) {
        const Quad ratio = static_cast<Quad>(count) / (count - 1 - j);
        QuadVector<N> better = last;
        for (int i = 0; i < N; ++i) better[i] += (last[i] - row[j][i]) / (ratio - 1);
        row[j] = last;
        if (j == k - 1) {
          error = 0;
          for (int i = 0; i < N; ++i) {
            const Quad size = fabsq(better[i]) > floor ? fabsq(better[i]) : floor;
            const Quad scaled = fabsq(better[i] - last[i]) / (tolerance * size);
            if (!(scaled <= error)) error = scaled;
          }
        }
        last = better;
      }
      row.push_back(last);
    }
    const auto columns = static_cast<Quad>(row.size());
    const Quad factor =
        powq(error > static_cast<Quad>(1e-20) ? error : static_cast<Quad>(1e-20), -1 / columns) *
        static_cast<Quad>(0.7);
    if (error <= 1) {
      t += step;
      y = row.back();
      step *= factor < 1 ? 1 : factor > 4 ? 4 : factor;
      if (columns > 8) step *= static_cast<Quad>(0.8);
    } else {
      step *= factor > static_cast<Quad>(0.5) || factor != factor ? static_cast<Quad>(0.5) : factor;
    }
  }
  return y;
}

}  // namespace naiad::physics
