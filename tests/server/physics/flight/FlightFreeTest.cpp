#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightFree.h"
#include "physics/geometry/Place.h"
#include "shared/values/SplitMix64.h"

namespace naiad::physics {
namespace {

TEST(Place, FractionStaysWithinHalfACell) {
  SplitMix64 random(1);
  Place place{};
  for (int i = 0; i < 10000; ++i) {
    const double size = std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);
    const Place next = place + Vec2{size * (random.unit() - 0.5), size * (random.unit() - 0.5)};
    EXPECT_LE(std::fabs(next.dx), 0.5);
    EXPECT_LE(std::fabs(next.dy), 0.5);
    place = next;
  }
  for (const double x : {0.5, 1.5, -0.5, -1.5, 2.5}) {  // each place has only one pair of cell and remainder
    EXPECT_EQ(placeAt({x, 0}).dx, -0.5);
    EXPECT_EQ(placeAt({x, 0}), (placeAt({x + 1, 0}) + Vec2{-1, 0}));
  }
}

TEST(Place, DifferencesAreExact) {
  const Place here = {1'000'000'000, -5, 0.25, -0.125};
  const Vec2 by = {3.0 + 0x1p-40, -7.5};
  EXPECT_EQ((here + by) - here, by);
  EXPECT_EQ(here - (here + by), -by);
  EXPECT_EQ(placeAt({2.25, -1.5}) - Place{}, (Vec2{2.25, -1.5}));
}

TEST(Place, SlowMoverStillMovesFarAway) {
  Place place = {1'000'000'000, 0, 0, 0};
  for (int i = 0; i < 1000; ++i) place = place + flyFree({1e-9, 0}, {}, 1).displacement;
  EXPECT_NEAR((place - Place{1'000'000'000, 0, 0, 0}).x, 1e-6, 1e-18);
}

}  // namespace
}  // namespace naiad::physics
