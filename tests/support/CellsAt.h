// A place in the world, for tests.
#pragma once

#include "shared/values/Fixed.h"
#include "shared/values/Vector.h"

namespace naiad::test {

/// In cells; within range.
inline df::FixedVector cellsAt(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

}  // namespace naiad::test
