// Four floats in parallel, for solving contacts.
//
// Uses plain operators on the compiler's vectors, with one rounding each, so that all processors get equal
// bits with or without vector instructions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad::physics {

inline constexpr std::size_t kLanes = 4;

using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneMask = std::int32_t __attribute__((vector_size(kLanes * sizeof(float))));

inline Lanes lanesOf(float x) {
  return Lanes{x, x, x, x};
}
inline Lanes select(LaneMask mask, Lanes a, Lanes b) {
  return mask ? a : b;
}
inline Lanes larger(Lanes a, Lanes b) {
  return select(a > b, a, b);
}
inline Lanes smaller(Lanes a, Lanes b) {
  return select(a < b, a, b);
}

/// Exchanges rows and columns of the 4 × 4 matrix whose rows are a, b, c and d.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Lanes ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Lanes cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace naiad::physics
