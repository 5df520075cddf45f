#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightField.h"
#include "physics/flight/FlightFree.h"
#include "physics/flight/FlightSpring.h"
#include "physics/geometry/Place.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BitHash.h"

namespace naiad::physics {
namespace {

class Hash : public test::BitHash {
 public:
  using BitHash::add;
  void add(const Flown& f) { add(f.displacement), add(f.velocity); }
};

struct Whirl : ForceField {
  double stiffness = 1;
  Vec2 acceleration(Vec2 p, Vec2 v, double t) const override {
    return -stiffness * p + perpendicular(v) * (1 + 0.1 * t) - 0.3 * length(v) * v;
  }
};

// All kinds of flight together have one hash, for every compiler and optimisation level.
TEST(Flight, HashIsTheSameOnEveryPlatform) {
  SplitMix64 random(1);
  Hash hash;
  const auto any = [&](double size) { return size * (2 * random.unit() - 1); };
  const auto vector = [&](double size) { return Vec2{any(size), any(size)}; };
  IntegratorCounters counters;
  for (int i = 0; i < 2000; ++i) {
    const double t = random.unit(), scale = std::ldexp(1, static_cast<int>(random.below(40)) - 5);
    const double big = scale * random.unit();
    const Vec2 p = vector(10), v = vector(5), a = vector(1);
    hash.add(flyFree(v, a, t));
    hash.add(flySpring({}, v, a, {0, big}, t));
    hash.add(flySpring(p, v, a, {big, i % 2 == 0 ? 0 : 4 * random.unit() * std::sqrt(big)}, t));
    const FlownOnLine line = flyQuadraticDragOnLine(v.x, a.x, 0.1 * random.unit(), t);
    hash.add(line.displacement), hash.add(line.velocity);
    Flown flown;
    flyQuadraticDrag(v, a, random.unit(), t, flown, counters);
    hash.add(flown);
  }
  for (int method = 0; method <= static_cast<int>(IntegratorMethod::kRadau); ++method) {
    IntegratorOptions options;
    options.method = static_cast<IntegratorMethod>(method);
    for (const double stiffness : {1.0, 1e3, 1e7}) {
      Whirl field;
      field.stiffness = stiffness;
      for (int i = 0; i < 5; ++i) {
        Flown flown;
        const Vec2 p = vector(1), v = vector(1);
        flyField(field, p, v, i, 0.1, options, flown, counters);
        if (isFinite(flown.displacement) && isFinite(flown.velocity)) hash.add(flown);
      }
    }
  }
  hash.add(static_cast<double>(counters.evaluations));
  hash.add(static_cast<double>(counters.newton_failures));
  EXPECT_EQ(hash.value(), 0x1a6e88aae8a55e41ULL) << std::hex << hash.value();
}

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
