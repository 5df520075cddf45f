// Limits of numbers that a game may set on bodies.
#pragma once

#include <cmath>

#include "shared/values/Vector.h"

namespace df {

inline constexpr double kMaxBodyNumber = 1e30;  ///< limit of all other numbers: products of two are finite
inline constexpr double kMaxSpin = 1e6;         ///< rad per tick; a double does not resolve faster angles

// All functions below return false for NaN.

inline bool isUsable(double value) {
  return std::abs(value) <= kMaxBodyNumber;
}
inline bool isUsable(Vector v) {
  return isUsable(v.x()) && isUsable(v.y());
}
inline bool isUsableSize(double value) {
  return value >= 0 && value <= kMaxBodyNumber;
}

}  // namespace df
