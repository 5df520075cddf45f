// Shapes centred on their own origin.
#pragma once

#include <gtest/gtest.h>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics::test {

inline ConvexShape boxShape(double half_width, double half_height) {
  ConvexShape shape;
  EXPECT_EQ(makeBox(half_width, half_height, {}, {}, 0, shape), ShapeStatus::kOk);
  return shape;
}

inline ConvexShape circleShape(double radius) {
  ConvexShape shape;
  EXPECT_EQ(makeCircle(radius, {}, shape), ShapeStatus::kOk);
  return shape;
}

}  // namespace naiad::physics::test
