#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shared/values/Box.h"
#include "shared/values/Fixed.h"
#include "shared/values/SplitMix64.h"

namespace df {
namespace {

TEST(Fixed, RoundsToNearestWithTiesToEven) {
  constexpr double kUnit = 0x1p-32;
  EXPECT_EQ(toFixed(1.0), kFixedOne);
  EXPECT_EQ(toFixed(-1.5), -kFixedOne - kFixedOne / 2);
  EXPECT_EQ(toFixed(0.5 * kUnit), 0);
  EXPECT_EQ(toFixed(1.5 * kUnit), 2);
  EXPECT_EQ(toFixed(-0.5 * kUnit), 0);
  EXPECT_EQ(toFixed(-1.5 * kUnit), -2);
  EXPECT_EQ(toFixed(0.75 * kUnit), 1);
}

TEST(Fixed, RefusesNonFiniteAndOutOfRangeNumbers) {
  EXPECT_FALSE(toFixed(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(toFixed(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(toFixed(-std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(toFixed(kMaxCells));
  EXPECT_TRUE(toFixed(-kMaxCells));
  EXPECT_FALSE(toFixed(std::nextafter(kMaxCells, 3e9)));
  EXPECT_FALSE(toFixed(-std::nextafter(kMaxCells, 3e9)));
  EXPECT_TRUE(toFixed(7.0, 7.0));
  EXPECT_FALSE(toFixed(7.5, 7.0));
}

TEST(Fixed, ExactThroughDoublesUpTo2To21Cells) {
  naiad::SplitMix64 rng(1);
  for (int i = 0; i < 10'000; ++i) {
    const Fixed value = static_cast<Fixed>(rng.below(std::uint64_t{1} << 54)) - (Fixed{1} << 53);
    ASSERT_EQ(toFixed(toCells(value)), value);
  }
}

TEST(Fixed, CellRoundsHalfUp) {
  EXPECT_EQ(cellOf(0), 0);
  EXPECT_EQ(cellOf(kFixedOne / 2 - 1), 0);
  EXPECT_EQ(cellOf(kFixedOne / 2), 1);
  EXPECT_EQ(cellOf(-kFixedOne / 2), 0);
  EXPECT_EQ(cellOf(-kFixedOne / 2 - 1), -1);
  EXPECT_EQ(cellOf(fromCells(-7)), -7);
  EXPECT_EQ(cellOf(fromCells(2'000'000'000)), 2'000'000'000);
}

TEST(Fixed, CellWrapsAtTheEndOfTheType) {
  EXPECT_EQ(cellOf(std::numeric_limits<Fixed>::max()), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(cellOf(std::numeric_limits<Fixed>::min()), std::numeric_limits<std::int32_t>::min());
}

TEST(Fixed, ALegalPositionPlusALegalVelocityFits) {
  Fixed sum = 0;
  EXPECT_FALSE(__builtin_add_overflow(*toFixed(kMaxCells), *toFixed(kMaxVelocityCells), &sum));
  EXPECT_FALSE(__builtin_add_overflow(*toFixed(-kMaxCells), *toFixed(-kMaxVelocityCells), &sum));
}

TEST(Fixed, TouchingBoxesIntersect) {
  const FixedBox box{{0, 0}, {kFixedOne, kFixedOne}};
  EXPECT_TRUE(intersects(box, translate(box, {kFixedOne, kFixedOne})));
  EXPECT_TRUE(intersects(box, translate(box, {-kFixedOne, 0})));
  EXPECT_FALSE(intersects(box, translate(box, {kFixedOne + 1, 0})));
  EXPECT_FALSE(intersects(box, translate(box, {0, -kFixedOne - 1})));
}

TEST(Fixed, BoxesWithNegativeOrHugeSizesAreRefused) {
  EXPECT_TRUE(toFixed(Box(Vector(-1, -1), 2, 0)));
  EXPECT_FALSE(toFixed(Box(Vector(0, 0), -1, 2)));
  EXPECT_FALSE(toFixed(Box(Vector(0, 0), 2, -0.5)));
  EXPECT_FALSE(toFixed(Box(Vector(2e6, 0), 1, 1)));
  EXPECT_FALSE(toFixed(Box(Vector(0, 0), 11, 1), 10));
  const Box box(Vector(-3.25, 4.5), 6.5, 1.75);
  EXPECT_EQ(fromFixed(*toFixed(box)), box);
}

}  // namespace
}  // namespace df
