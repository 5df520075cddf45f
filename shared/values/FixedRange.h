// The largest position and velocity components as fixed-point numbers, and a comparison with them.
#pragma once

#include "shared/values/Fixed.h"

namespace df {

inline constexpr Fixed kMaxPosition = static_cast<Fixed>(kMaxCells) * kFixedOne;
inline constexpr Fixed kMaxVelocity = static_cast<Fixed>(kMaxVelocityCells) * kFixedOne;

/// True if no component is farther from 0 than `most`.
constexpr bool isWithin(FixedVector v, Fixed most) {
  return v.x >= -most && v.x <= most && v.y >= -most && v.y <= most;
}

}  // namespace df
