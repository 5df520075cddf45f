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

}  // namespace naiad::physics
