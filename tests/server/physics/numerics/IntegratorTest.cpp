#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/flight/FlightField.h"
#include "physics/numerics/IntegratorAutomatic.h"

namespace naiad::physics {
namespace {

struct Kepler : ForceField {
  Vec2 acceleration(Vec2 p, Vec2, double) const override {
    const double r2 = lengthSquared(p);
    return p * (-1 / (r2 * std::sqrt(r2)));
  }
};

double energyOf(Vec2 p, Vec2 v) {
  return 0.5 * lengthSquared(v) - 1 / length(p);
}

struct OrbitResult {
  double end_error = 0;
  double energy_error = 0;
  double evaluations_per_orbit = 0;
};

// Integrates an orbit of eccentricity 0.6 from the perihelion, in ticks of 1/30.
OrbitResult orbit(const IntegratorOptions& options, int orbits) {
  const Kepler field;
  const Vec2 p0 = {0.4, 0}, v0 = {0, 2};
  Vec2 p = p0, v = v0;
  IntegratorCounters counters;
  OrbitResult result;
  const double duration = orbits * 6.283185307179586, h = 1.0 / 30;
  const int ticks = static_cast<int>(duration / h);
  for (int i = 0; i <= ticks; ++i) {
    const double dt = i < ticks ? h : duration - ticks * h;
    Flown flown;
    EXPECT_EQ(flyField(field, p, v, i * h, dt, options, flown, counters), IntegratorStatus::kDone);
    p += flown.displacement;
    v = flown.velocity;
    result.energy_error = std::max(result.energy_error, std::fabs(energyOf(p, v) / energyOf(p0, v0) - 1));
  }
  result.end_error = length(p - p0);
  result.evaluations_per_orbit = static_cast<double>(counters.evaluations) / orbits;
  return result;
}

TEST(Integrator, KeplerReturnsToItsStartAfterTwentyOrbits) {
  const OrbitResult own = orbit({}, 20);
  EXPECT_LE(own.end_error, 1e-5);
  EXPECT_LE(own.energy_error, 1e-10);
  EXPECT_LE(own.evaluations_per_orbit, 16000);
}

TEST(Integrator, KeplerErrorFollowsTheTolerance) {
  for (const IntegratorMethod method : {IntegratorMethod::kExtrapolation, IntegratorMethod::kRadau}) {
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
      IntegratorOptions options = {.method = method};
      options.relative = options.absolute = options.stiff_relative = options.stiff_absolute = tolerance;
      EXPECT_LE(orbit(options, 1).end_error, 2e5 * tolerance) << tolerance;
    }
  }
}

TEST(Integrator, FieldGetsTheWorldsTime) {
  struct Tide : ForceField {
    Vec2 acceleration(Vec2, Vec2, double t) const override { return {df::math::cos(t), 0}; }
  } field;
  for (const IntegratorMethod method : {IntegratorMethod::kAutomatic, IntegratorMethod::kRadau}) {
    const IntegratorOptions options = {.method = method};
    IntegratorCounters counters;
    Flown flown;
    ASSERT_EQ(flyField(field, {}, {}, 5, 1, options, flown, counters), IntegratorStatus::kDone);
    EXPECT_NEAR(flown.velocity.x, std::sin(6) - std::sin(5), 1e-7);
  }
}

constexpr IntegratorMethod kMethods[] = {IntegratorMethod::kAutomatic, IntegratorMethod::kExtrapolation,
                                         IntegratorMethod::kRadau};

// A body enters a zone with another gravity, anywhere within the tick, in a world that has run for years.
TEST(Integrator, HandlesAJumpOfTheForce) {
  struct Zone : ForceField {
    double border = 0;
    Vec2 acceleration(Vec2 p, Vec2, double) const override { return p.x < border ? Vec2{} : Vec2{0, 10}; }
  } field;
  for (const IntegratorMethod method : kMethods) {
    const IntegratorOptions options = {.method = method};
    IntegratorCounters counters;
    for (int i = 0; i < 500; ++i) {
      field.border = (i + 0.5) / 500;
      Flown flown;
      ASSERT_EQ(flyField(field, {}, {1, 0}, 1e9, 1, options, flown, counters), IntegratorStatus::kDone);
      const double within = 1 - field.border;
      EXPECT_NEAR(flown.velocity.y, 10 * within, 1e-9);
      EXPECT_NEAR(flown.displacement.y, 5 * within * within, 1e-9);
    }
    EXPECT_LE(counters.evaluations / 500, 2000);
  }
}

TEST(Integrator, NonFiniteForcesFailAndSingularitiesStop) {
  struct Broken : ForceField {
    Vec2 acceleration(Vec2 p, Vec2, double) const override { return {std::sqrt(p.x), 0}; }
  } broken;
  struct Blow : ForceField {  // its motion reaches infinity within the tick
    Vec2 acceleration(Vec2, Vec2 v, double) const override { return v * length(v) * 2; }
  } blow;
  for (const IntegratorMethod method : kMethods) {
    const IntegratorOptions options = {.method = method};
    IntegratorCounters counters;
    Flown flown;
    EXPECT_EQ(flyField(broken, {-1, 0}, {}, 0, 1, options, flown, counters), IntegratorStatus::kNotFinite);
    EXPECT_EQ(counters.failed_calls, 1);
    EXPECT_NE(flyField(blow, {}, {1, 0}, 0, 1, options, flown, counters), IntegratorStatus::kDone);
    EXPECT_EQ(counters.failed_calls, 2);
    EXPECT_LE(counters.evaluations, 1000000);
    EXPECT_TRUE(isFinite(flown.displacement));
  }
}

}  // namespace
}  // namespace naiad::physics
