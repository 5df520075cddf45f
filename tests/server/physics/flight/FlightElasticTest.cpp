#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightSpring.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/ElasticField.h"

namespace naiad::physics {
namespace {

TEST(ElasticField, JacobianMatchesItsAcceleration) {
  SplitMix64 random(1);
  const auto any = [&] { return 4 * random.unit() - 2; };
  for (int i = 0; i < 1000; ++i) {
    const ElasticField field(3, 0.7, 1.2, {0, 10});
    const Vec2 p = {any(), any()}, v = {any(), any()};
    if (length(p) < 0.1) continue;
    Mat22 by_p, by_v;
    ASSERT_TRUE(field.jacobian(p, v, 0, by_p, by_v));
    const double h = 1e-5;
    for (const Vec2 by : {Vec2{h, 0}, Vec2{0, h}}) {
      const Vec2 of_p = field.acceleration(p + by, v, 0) - field.acceleration(p - by, v, 0);
      const Vec2 of_v = field.acceleration(p, v + by, 0) - field.acceleration(p, v - by, 0);
      EXPECT_LE(length(of_p - by_p * (2 * by)), 1e-7 * h * (1 + 1 / std::pow(length(p), 3)) * 100);
      EXPECT_LE(length(of_v - by_v * (2 * by)), 1e-9 * h * 100);
    }
  }
}

// In the stiffest case, a tick has 53 oscillations, too many for the limit of calls, so its error may be
// larger.
TEST(ElasticField, LineMotionMatchesTheClosedForm) {
  const struct {
    double k;
    double most;
  } kCases[] = {{10, 1e-9}, {1e4, 1e-9}, {1e8, 2e-6}};
  for (const auto& [k, most] : kCases) {
    const double c = 0.2 * std::sqrt(k);
    const ElasticField field(k, c, 2, {0, 10});
    const Vec2 p = {0, 2.1}, v = {0, -0.3};
    IntegratorCounters counters;
    Flown flown;
    ASSERT_EQ(flyField(field, p, v, 0, 1.0 / 30, {}, flown, counters), IntegratorStatus::kDone);
    const Flown exact = flySpring(p - Vec2{0, 2}, v, {0, 10}, {k, c}, 1.0 / 30);
    EXPECT_NEAR(flown.displacement.y, exact.displacement.y, most);
    EXPECT_NEAR(flown.velocity.y, exact.velocity.y, most * std::sqrt(k));
    EXPECT_LE(counters.evaluations, 10'000);
    EXPECT_EQ(flown.displacement.x, 0);
  }
}

TEST(ElasticField, ExertsNoForceAtItsOrigin) {
  const ElasticField field(3, 0.7, 1, {0, 10});
  EXPECT_EQ(field.acceleration({}, {1, 1}, 0), (Vec2{0, 10}));
  Mat22 by_p, by_v;
  EXPECT_TRUE(field.jacobian({}, {1, 1}, 0, by_p, by_v));
  EXPECT_EQ(by_p, Mat22{});
}

}  // namespace
}  // namespace naiad::physics
