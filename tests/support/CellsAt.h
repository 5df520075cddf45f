// Makes world positions for tests.
#pragma once

#include "shared/values/Fixed.h"
#include "shared/values/Vector.h"

namespace naiad::test {

/// Returns the position (x, y), in cells. Both must be within range.
inline df::FixedVector cellsAt(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

}  // namespace naiad::test
