#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightFree.h"
#include "physics/flight/FlightSpring.h"
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

// All kinds of flight have equal bits far away and at the origin.
TEST(Place, FlightIsTheSameAtABillionCells) {
  const auto fly = [](std::int64_t far) {
    const Place anchor = {far, -far, 0.125, 0.25};
    Place free = {far + 3, -far, 0.1, -0.3}, sprung = free, dragged = free;
    Vec2 v_free = {1e-7, 0.003}, v_sprung = v_free, v_dragged = {0.7, -0.2};
    const Vec2 gravity = {0, 0.01};
    const SpringFlow spring({0.05, 0.01}, 1);
    const SpringFlow drag({0, 0.02}, 1);
    for (int i = 0; i < 1000; ++i) {
      Flown f = flyFree(v_free, gravity, 1);
      free = free + f.displacement, v_free = f.velocity;
      f = spring(sprung - anchor, v_sprung, gravity);
      sprung = sprung + f.displacement, v_sprung = f.velocity;
      f = drag({}, v_dragged, gravity);
      dragged = dragged + f.displacement, v_dragged = f.velocity;
    }
    const auto relative = [&](Place p) { return Place{p.cell_x - far, p.cell_y + far, p.dx, p.dy}; };
    return std::array{relative(free), relative(sprung), relative(dragged)};
  };
  const auto here = fly(0);
  EXPECT_EQ(here, fly(1'000'000));
  EXPECT_EQ(here, fly(1'000'000'000));
  EXPECT_EQ(here, fly(-4'000'000'000'000));
}

TEST(Place, SlowMoverStillMovesFarAway) {
  Place place = {1'000'000'000, 0, 0, 0};
  for (int i = 0; i < 1000; ++i) place = place + flyFree({1e-9, 0}, {}, 1).displacement;
  EXPECT_NEAR((place - Place{1'000'000'000, 0, 0, 0}).x, 1e-6, 1e-18);
}

}  // namespace
}  // namespace naiad::physics
