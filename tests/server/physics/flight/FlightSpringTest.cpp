#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightSpring.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/QuadReference.h"

namespace naiad::physics {
namespace {

// The solution x and v at t of x″ = a − kx − cx′, from the characteristic roots.
struct QuadState {
  Quad x, v;
};
QuadState reference(double k, double c, double a, double x0, double v0, Quad t) {
  const Quad half = q(c) / 2, disc = half * half - q(k), rest = q(a) / q(k), d = q(x0) - rest;
  const Quad decay = expq(-half * t);
  if (disc < 0) {
    const Quad w = sqrtq(-disc), s = sinq(w * t), co = cosq(w * t), b = (q(v0) + half * d) / w;
    return {rest + decay * (d * co + b * s), decay * ((b * w - half * d) * co - (d * w + half * b) * s)};
  }
  if (disc == 0) {
    const Quad b = q(v0) + half * d;
    return {rest + decay * (d + b * t), decay * (b - half * (d + b * t))};
  }
  const Quad w = sqrtq(disc), fast = half + w, slow = q(k) / fast;
  if (w * t < 1) {  // nearly critical damping: two decays would cancel
    const Quad s = sinhq(w * t) / w, co = coshq(w * t);
    return {rest + decay * (d * (co + half * s) + q(v0) * s),
            decay * (q(v0) * (co - half * s) - q(k) * d * s)};
  }
  const Quad of_slow = (q(v0) + fast * d) / (2 * w), of_fast = d - of_slow;
  const Quad es = expq(-slow * t), ef = expq(-fast * t);
  return {rest + of_slow * es + of_fast * ef, -slow * of_slow * es - fast * of_fast * ef};
}

TEST(Spring, OneStepIsExactForAnyParameters) {
  SplitMix64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const auto any = [&](double low, double high) {
      return std::pow(10, low + (high - low) * random.unit());
    };
    const double k = any(-8, 12), t = any(-3, 2);
    double c = i % 3 == 0 ? 2 * std::sqrt(k) * (1 + any(-16, 0) * (i % 2 ? 1 : -1)) : any(-12, 8);
    if (i % 17 == 0) c = 0;
    const double omega = std::sqrt(k);
    if (omega * t > 1e6) continue;
    const SpringFlow flow({k, c}, t);
    const Flown kicked = flow({0, 0}, {1, 0}, {0, 0}), pulled = flow({1, 0}, {0, 0}, {0, 0}),
                pushed = flow({0, 0}, {0, 0}, {1, 0});
    const QuadState kick = reference(k, c, 0, 0, 1, q(t)), pull = reference(k, c, 0, 1, 0, q(t)),
                    push = reference(k, c, 1, 0, 0, q(t));
    // The errors are in units of the largest possible values within t.
    const double time = 1 / std::fmax(1 / t, std::fmax(omega, c / 2));
    const double reach = std::fmin(t, 1 / omega);
    for (const double error :
         {std::fabs(static_cast<double>(q(kicked.displacement.x) - kick.x)) / time,
          std::fabs(static_cast<double>(q(kicked.velocity.x) - kick.v)),
          std::fabs(static_cast<double>(q(1 + pulled.displacement.x) - pull.x)),
          std::fabs(static_cast<double>(q(pulled.velocity.x) - pull.v)) / (k * time),
          std::fabs(static_cast<double>(q(pushed.displacement.x) - push.x)) / (reach * reach),
          std::fabs(static_cast<double>(q(pushed.velocity.x) - push.v)) / time}) {
      ASSERT_LE(error, 1e-14) << "k " << k << " c " << c << " t " << t;
    }
  }
}

TEST(Spring, StaysBoundedAtAnyStiffnessAndStep) {
  for (const double k : {1e-30, 1e10, 1e20, 1e30}) {
    for (const double c : {0.0, 1e-3, 1e15, 1e30}) {
      for (const double t : {1e-12, 1.0, 1e6}) {
        const SpringFlow flow({k, c}, t);
        double x = 1, v = 0;
        for (int i = 0; i < 1000; ++i) {
          const Flown f = flow({x, 0}, {v, 0}, {0, 0});
          x += f.displacement.x;
          v = f.velocity.x;
          ASSERT_LE(std::fabs(x), 1 + 1e-11) << k << " " << c << " " << t;
          ASSERT_LE(std::fabs(v), (1 + 1e-11) * std::sqrt(k)) << k << " " << c << " " << t;
        }
      }
    }
  }
}

}  // namespace
}  // namespace naiad::physics
