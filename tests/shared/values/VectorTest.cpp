#include <gtest/gtest.h>

#include <limits>

#include "shared/values/Vector.h"

namespace df {
namespace {

TEST(Vector, KeepsDoublePrecisionBehindFloatGetters) {
  Vector v;
  v.setXY(100'000.015625, -0.1);
  EXPECT_EQ(v.x(), 100'000.015625);
  EXPECT_EQ(v.y(), -0.1);
  EXPECT_EQ(v.getX(), 100'000.015625f);
  EXPECT_EQ(v.getY(), -0.1f);
}

TEST(Vector, AddsSubtractsAndScales) {
  Vector v = Vector(1, 2) + Vector(3, -5);
  EXPECT_EQ(v, Vector(4, -3));
  EXPECT_EQ(v.getMagnitude(), 5.0f);
  v.scale(-2);
  EXPECT_EQ(v, Vector(-8, 6));
  EXPECT_EQ(v - Vector(2, 2), Vector(-10, 4));
}

TEST(Vector, NormalizedHasLengthOneAndTheSameDirection) {
  Vector v(-3, 4);
  v.normalize();
  EXPECT_EQ(v, Vector(-0.6, 0.8));
}

TEST(Vector, NormalizingTheZeroVectorChangesNothing) {
  Vector v;
  v.normalize();
  EXPECT_EQ(v, Vector());
}

TEST(Vector, FixedPointIsRefusedIfEitherComponentIsBad) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(toFixed(Vector(nan, 0)));
  EXPECT_FALSE(toFixed(Vector(0, nan)));
  EXPECT_FALSE(toFixed(Vector(0, 2.5), 2));
  ASSERT_TRUE(toFixed(Vector(-2, 1.5), 2));
  EXPECT_EQ(Vector::fromFixed(*toFixed(Vector(-2, 1.5), 2)), Vector(-2, 1.5));
}

}  // namespace
}  // namespace df
