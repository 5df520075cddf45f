#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightSpring.h"
#include "physics/geometry/Place.h"
#include "tests/server/physics/QuadReference.h"

namespace naiad::physics {
namespace {

// Returns ∫∫ of e^−ct in quadruple precision; uses a series where the formula would cancel.
Quad wayOfPush(Quad c, Quad t) {
  const Quad z = c * t;
  if (z > q(1e-3)) return (z + expm1q(-z)) / (c * c);
  Quad sum = 0, term = t * t / 2;
  for (int n = 3; n < 20; ++n) {
    sum += term;
    term *= -z / n;
  }
  return sum;
}

// It is a spring without stiffness, so that the place on it has no effect.
TEST(LinearDrag, IsExactFromZeroToExtremeDrag) {
  for (const double t : {1.0, 1.0 / 30, 2.0, 1e4}) {
    for (double c = 1e-300; c < 1e300; c *= 3.7) {
      const Flown flown = flySpring({5, 5}, {10, 0}, {0, -7}, {0, c}, t);
      const Quad left = expq(-q(c) * q(t)), displacement = -expm1q(-q(c) * q(t)) / q(c);
      const auto relative = [&](double value, Quad truth) {
        if (fabsq(truth) < q(1e-300)) return std::fabs(value) < 1e-290 ? 0.0 : 1.0;
        return static_cast<double>(fabsq((q(value) - truth) / truth));
      };
      for (const double error :
           {relative(flown.velocity.x, 10 * left) / std::fmax(1, std::fmin(c * t, 750)),
            relative(flown.displacement.x, 10 * displacement), relative(flown.velocity.y, -7 * displacement),
            relative(flown.displacement.y, -7 * wayOfPush(q(c), q(t)))}) {
        EXPECT_LE(error, 1e-14) << c << ", " << t;
      }
    }
  }
  const Flown none = flySpring({5, 5}, {3, 4}, {0, 2}, {0, 0}, 5);
  EXPECT_EQ(none.displacement, (Vec2{15, 45}));
  EXPECT_EQ(none.velocity, (Vec2{3, 14}));
}

// Flight with quadratic drag along a line, by other formulas than those of the product.
FlownOnLine referenceOnLine(double velocity, double acceleration, double drag, double time) {
  Quad v = q(velocity), t = q(time), displacement = 0;
  const Quad a = q(acceleration), c = q(drag);
  if (a == 0) {
    return {static_cast<double>((v < 0 ? -1 : 1) * logq(1 + c * fabsq(v) * t) / c),
            static_cast<double>(v / (1 + c * fabsq(v) * t))};
  }
  const Quad limit = sqrtq(a / c);  // here a > 0
  if (v < 0) {
    const Quad angle = atanq(-v / limit), rate = sqrtq(a * c);
    const Quad until = angle / rate;
    const Quad used = t < until ? t : until;
    displacement = -logq(cosq(angle - rate * used) / cosq(angle)) / c;
    v = -limit * tanq(angle - rate * used);
    t -= used;
    if (t == 0) return {static_cast<double>(displacement), static_cast<double>(v)};
    v = 0;
  }
  const Quad phase = sqrtq(a * c) * t;
  const Quad w = v / limit;
  displacement += logq(coshq(phase) + w * sinhq(phase)) / c;
  const Quad end = limit * (w + tanhq(phase)) / (1 + w * tanhq(phase));
  return {static_cast<double>(displacement), static_cast<double>(end)};
}

TEST(QuadraticDrag, StraightFlightMatchesTheClosedForm) {
  for (const double t : {1.0 / 30, 1.0, 40.0}) {
    for (const double c : {1e-8, 1e-4, 0.01, 0.3, 2.0, 50.0}) {
      for (const double a : {0.0, 1e-6, 0.01, 1.0, 10.0, 1e3}) {
        for (const double v : {-1e4, -20.0, -1.0, -1e-3, 0.0, 1e-3, 0.7, 10.0, 300.0, 1e6}) {
          if (a == 0 && v == 0) continue;
          const FlownOnLine own = flyQuadraticDragOnLine(v, a, c, t);
          const FlownOnLine truth = referenceOnLine(v, a, c, t);
          // The movements back and forth may cancel.
          const double scale = std::fmax(std::fabs(truth.displacement),
                                         v < 0 ? 0.01 * std::fabs(v) * t / (1 + c * -v * t) : 0);
          const double error = std::fmax(
              std::fabs(own.displacement - truth.displacement) / scale,
              std::fabs(own.velocity - truth.velocity) /
                  std::fmax(std::fabs(truth.velocity), v < 0 ? 0.01 * a * t / (1 + c * a * t * t) : 0));
          EXPECT_LE(error, 1e-12) << "v " << v << " a " << a << " drag " << c << " t " << t;
          const FlownOnLine mirrored = flyQuadraticDragOnLine(-v, -a, c, t);
          EXPECT_EQ(mirrored.displacement, -own.displacement);
          EXPECT_EQ(mirrored.velocity, -own.velocity);
        }
      }
    }
  }
}

TEST(QuadraticDrag, ZeroDragIsFreeFlight) {
  for (const double drag : {0.0, 1e-300, 1e-320}) {
    const FlownOnLine flown = flyQuadraticDragOnLine(-3, 2, drag, 5);
    EXPECT_NEAR(flown.displacement, 10, 1e-12);
    EXPECT_NEAR(flown.velocity, 7, 1e-12);
  }
}

TEST(QuadraticDrag, PlanarFlightIsWithinTolerance) {
  IntegratorCounters counters;
  for (const double drag : {1e-4, 0.05, 1.0}) {
    for (const Vec2 start : {Vec2{10, 0}, Vec2{3, -20}, Vec2{200, 100}}) {
      const Vec2 gravity = {0, 10};
      const QuadSystem<4> system = [&](Quad, const QuadVector<4>& y) {
        const Quad speed = sqrtq(y[2] * y[2] + y[3] * y[3]);
        return QuadVector<4>{y[2], y[3], q(gravity.x) - q(drag) * speed * y[2],
                             q(gravity.y) - q(drag) * speed * y[3]};
      };
      const auto truth = quadSolve<4>(system, 0, 2, {0, 0, q(start.x), q(start.y)}, 1000, 5);
      Place place{};
      Vec2 velocity = start;
      for (int i = 0; i < 64; ++i) {
        Flown flown;
        ASSERT_EQ(flyQuadraticDrag(velocity, gravity, drag, 2.0 / 64, flown, counters),
                  IntegratorStatus::kDone);
        place = place + flown.displacement;
        velocity = flown.velocity;
      }
      const Vec2 displacement = place - Place{};
      const double error = length({displacement.x - static_cast<double>(truth[0]),
                                   displacement.y - static_cast<double>(truth[1])}) /
                           length(displacement);
      EXPECT_LE(error, 1e-10);
    }
  }
}

TEST(QuadraticDrag, AnyDragIsIntegratedInBoundedSteps) {
  for (const double drag : {1e-12, 1e3, 1e9, 1e15}) {
    for (const double speed : {1e-9, 1.0, 1e6}) {
      IntegratorCounters counters;
      Flown flown;
      EXPECT_EQ(flyQuadraticDrag({speed, speed / 3}, {0, 0.01}, drag, 1, flown, counters),
                IntegratorStatus::kDone)
          << drag << ", " << speed << ": " << counters.evaluations << " " << counters.steps;
      EXPECT_LE(counters.steps, 2000);
      const double limit = std::sqrt(0.01 / drag);
      if (drag >= 1e9) {
        EXPECT_NEAR(flown.velocity.y, limit, 1e-6 * limit + 1e-15 * speed) << drag << ", " << speed;
        EXPECT_LE(std::fabs(flown.velocity.x), 1e-6 * limit + 1e-15 * speed) << drag << ", " << speed;
      }
    }
  }
}

}  // namespace
}  // namespace naiad::physics
