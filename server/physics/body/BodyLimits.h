// The numbers that bodies accept from a game.
#pragma once

#include <cmath>

#include "shared/values/Vector.h"

namespace df {

inline constexpr double kMaxBodyNumber = 1e30;  ///< of any number: products of two stay finite
inline constexpr double kMaxSpin = 1e6;  ///< rad per tick: an angle gains no more than a double resolves well

// All are false for NaN.

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
