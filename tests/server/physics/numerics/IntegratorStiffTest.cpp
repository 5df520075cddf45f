#include <gtest/gtest.h>

#include <cmath>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightField.h"
#include "physics/flight/FlightSpring.h"
#include "physics/numerics/IntegratorAutomatic.h"
#include "tests/server/physics/QuadReference.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

// A body that flies in a field, one tick after the other.
struct Flyer {
  Vec2 p, v;
  IntegratorCounters counters = {};

  void fly(const ForceField& field, double from, double dt, const IntegratorOptions& options = {}) {
    Flown flown;
    ASSERT_EQ(flyField(field, p, v, from, dt, options, flown, counters), IntegratorStatus::kDone) << from;
    p += flown.displacement;
    v = flown.velocity;
  }
  /// Flies for 60 ticks of 1/30: two seconds.
  void flyOn(const ForceField& field) {
    for (int i = 0; i < 60; ++i) fly(field, i / 30.0, 1 / 30.0);
  }
};

struct VanDerPol : ForceField {
  double epsilon = 1e-6;
  bool knows_jacobian = true;
  Vec2 acceleration(Vec2 p, Vec2 v, double) const override {
    return {((1 - p.x * p.x) * v.x - p.x) / epsilon, 0};
  }
  bool jacobian(Vec2 p, Vec2 v, double, Mat22& by_p, Mat22& by_v) const override {
    by_p = {(-2 * p.x * v.x - 1) / epsilon, 0, 0, 0};
    by_v = {(1 - p.x * p.x) / epsilon, 0, 0, 0};
    return knows_jacobian;
  }
};

// The start is x = 2, v = 0. The published results of stiff problems here and below are those of the "Test
// Set for Initial Value Problem Solvers".
TEST(Stiff, VanDerPolMatchesThePublishedResult) {
  for (const IntegratorMethod method : {IntegratorMethod::kAutomatic, IntegratorMethod::kRadau}) {
    for (const bool knows : {true, false}) {
      for (const int ticks : {2, 60, 240}) {
        VanDerPol field;
        field.knows_jacobian = knows;
        Flyer its = {{2, 0}, {}};
        for (int i = 0; i < ticks; ++i) its.fly(field, 2.0 * i / ticks, 2.0 / ticks, {.method = method});
        EXPECT_NEAR(its.p.x, 1.706167732170483, 1e-4);
        EXPECT_NEAR(its.v.x, -0.8928097010247975, 1e-4);
        EXPECT_EQ(its.counters.failed_calls, 0);
      }
    }
  }
}

Mat22 outer(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}

Mat22 scaled(const Mat22& m, double s) {
  return {m.xx * s, m.xy * s, m.yx * s, m.yy * s};
}

/// Pulls towards the field's origin from beyond `rest_length`, pushes away from within it, and damps motion
/// along the spring. Undefined at the origin.
class ElasticField final : public ForceField {
 public:
  /// `push` is an additional constant acceleration, such as gravity.
  ElasticField(double stiffness, double damping, double rest_length, Vec2 push)
      : m_stiffness(stiffness), m_damping(damping), m_rest_length(rest_length), m_push(push) {}

  Vec2 acceleration(Vec2 position, Vec2 velocity, double /*time*/) const override {
    const double distance = length(position);
    const Vec2 outward = position / distance;
    const double pull = m_stiffness * (distance - m_rest_length) + m_damping * dot(velocity, outward);
    return m_push - pull * outward;
  }

  bool jacobian(Vec2 position, Vec2 velocity, double /*time*/, Mat22& by_position,
                Mat22& by_velocity) const override {
    const double distance = length(position);
    const Vec2 outward = position / distance;
    const Mat22 along = outer(outward, outward);
    const Mat22 across = kIdentity + scaled(along, -1);
    const double radial = dot(velocity, outward);
    const double pull = m_stiffness * (distance - m_rest_length) + m_damping * radial;
    // Along the spring, the pull changes by the stiffness and, because the spring turns, by the velocity
    // across the spring. The pull's direction turns with the position.
    const Vec2 turning = (velocity - radial * outward) / distance;
    by_position = scaled(along, -m_stiffness) + scaled(outer(outward, turning), -m_damping) +
                  scaled(across, -pull / distance);
    by_velocity = scaled(along, -m_damping);
    return true;
  }

 private:
  double m_stiffness;    // force over length and mass, per unit of time squared
  double m_damping;      // force over velocity and mass, per unit of time
  double m_rest_length;  // metric cells
  Vec2 m_push;
};

// Returns the field of a rod with stiffness k. The pendulum starts horizontally. (Games should use a joint.)
ElasticField rod(double k) {
  return {k, 0, 1, {0, 10}};
}

void elasticPendulum(double k, int reference_steps, double bound) {
  const QuadSystem<4> system = [k](Quad, const QuadVector<4>& y) {
    const Quad r = sqrtq(y[0] * y[0] + y[1] * y[1]), f = q(k) * (r - 1) / r;
    return QuadVector<4>{y[2], y[3], -f * y[0], 10 - f * y[1]};
  };
  const double duration = 2;
  const auto truth = quadSolve<4>(system, 0, q(duration), {1, 0, 0, 0}, reference_steps, 4);
  Flyer bob = {{1, 0}, {}};
  bob.flyOn(rod(k));
  EXPECT_LE(length(bob.p - Vec2{static_cast<double>(truth[0]), static_cast<double>(truth[1])}), bound);
}

TEST(Stiff, ElasticPendulumIsAccurate) {
  elasticPendulum(1e4, 4000, 1e-9);
  elasticPendulum(1e6, 10000, 1e-8);
}

// The reference would take minutes for these k. The oscillation of the rod is smaller than the tolerance, so
// the swing is that of a rigid pendulum.
TEST(Stiff, NearlyRigidElasticPendulumSwingsLikeARod) {
  // theta'' = 10 cos(theta), where theta is the angle from the horizontal
  const QuadSystem<2> rigid = [](Quad, const QuadVector<2>& y) {
    return QuadVector<2>{y[1], 10 * cosq(y[0])};
  };
  const auto truth = quadSolve<2>(rigid, 0, 2, {0, 0}, 1000, 4);
  const Vec2 end = {static_cast<double>(cosq(truth[0])), static_cast<double>(sinq(truth[0]))};
  for (const double k : {1e8, 1e10}) {
    Flyer bob = {{1, 0}, {}};
    bob.flyOn(rod(k));
    EXPECT_LE(length(bob.p - end), 1e-4) << k;
  }
}

// A charge in a magnetic field perpendicular to the plane and an electric field in the plane gyrates and
// drifts.
TEST(Stiff, ChargedParticleMatchesTheClosedForm) {
  struct Charged : ForceField {
    double b = 1000;
    Vec2 acceleration(Vec2, Vec2 v, double) const override { return Vec2{0, 5} - b * perpendicular(v); }
    bool jacobian(Vec2, Vec2, double, Mat22&, Mat22& by_v) const override {
      by_v = {0, b, -b, 0};
      return true;
    }
  } field;
  for (const double b : {1.0, 1e2, 1e3, 1e4}) {
    field.b = b;
    Flyer its = {{}, {1, 0}};
    its.flyOn(field);
    // v' = E − B·(−v_y, v_x) has the drift (5/B, 0), and (1 − 5/B, 0) turns backwards at the rate B
    const Quad t = 2, w = q(b), u = 1 - 5 / w;
    const Vec2 end = {static_cast<double>(5 / w * t + u * sinq(w * t) / w),
                      static_cast<double>(-u * (1 - cosq(w * t)) / w)};
    EXPECT_LE(length(its.p - end), 1e-8);
    const Vec2 rest = its.v - Vec2{5 / b, 0};
    EXPECT_NEAR(length(rest), std::fabs(1 - 5 / b), 1e-8);
  }
}

// A magnet of any strength turns the velocity without braking, in a fixed number of calls. A gradient of its
// strength, a wind or a slope makes the body drift perpendicular to it.
TEST(Stiff, StrongMagnetTurnsButDoesNotBrake) {
  struct Magnet : ForceField {
    double rate = 1, slope = 0;
    Vec2 across;
    mutable int calls = 0;
    Vec2 acceleration(Vec2 at, Vec2 v, double) const override {
      ++calls;
      return across + (rate * (1 + slope * at.x)) * perpendicular(v);
    }
  } field;
  for (const double rate : {1.0, 30.0, 100.0, 1e3, -1e4, 1e6, 1e9}) {
    for (const double slope : {0.0, 0.3}) {
      field.rate = rate;
      field.slope = slope;
      field.across = {};
      Flyer its = {{}, {0.1, 0.05}};
      for (int i = 0; i < 100; ++i) {
        field.calls = 0;
        its.fly(field, i, 1);
        if (std::fabs(rate) > 64) {
          EXPECT_LE(field.calls, 66);
        }
        ASSERT_NEAR(length(its.v), length(Vec2{0.1, 0.05}), 1e-8) << rate << ' ' << i;
        ASSERT_LE(length(its.p), 6 * length(Vec2{0.1, 0.05}) / std::fabs(rate)) << rate << ' ' << i;
      }
    }
    if (std::fabs(rate) < 100) continue;
    field.slope = 0;
    field.across = {0, 0.01};
    Flyer its;
    for (int i = 0; i < 100; ++i) its.fly(field, i, 1);
    EXPECT_NEAR(its.p.x * rate, -1, 0.05) << rate;  // 100 ticks at a drift of 0.01 / rate, within the
                                                    // diameter of a turn
    EXPECT_NEAR(its.p.y * rate, 0, 0.05) << rate;
  }
}

struct Robertson {
  void derivative(double, const StateVector<3>& y, StateVector<3>& rate) const {
    const double a = 0.04 * y[0], b = 1e4 * y[1] * y[2], c = 3e7 * y[1] * y[1];
    rate = {-a + b, a - b - c, c};
  }
};

template <int N, class System>
void expectEnd(const System& system, double end, StateVector<N> y, const IntegratorOptions& options,
               const StateVector<N>& published, double bound) {
  IntegratorCounters counters;
  ASSERT_EQ(integrate<N>(system, 0, end, y, options, counters), IntegratorStatus::kDone);
  for (int i = 0; i < N; ++i) EXPECT_NEAR(y[i] / published[i], 1, bound) << i;
}

TEST(Stiff, RobertsonIsAccurateOverElevenDecades) {
  expectEnd<3>(Robertson{}, 1e11, {1, 0, 0},
               {.method = IntegratorMethod::kRadau, .stiff_relative = 1e-9, .stiff_absolute = 1e-18},
               {0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050}, 1e-6);
}

struct Hires {
  void derivative(double, const StateVector<8>& y, StateVector<8>& rate) const {
    const double meeting = 280 * y[5] * y[7];
    rate = {-1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007,
            1.71 * y[0] - 8.75 * y[1],
            -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4],
            8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3],
            -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6],
            -meeting + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6],
            meeting - 1.81 * y[6],
            -meeting + 1.81 * y[6]};
  }
};

TEST(Stiff, HiresMatchesThePublishedResult) {
  for (const IntegratorMethod method : {IntegratorMethod::kRadau, IntegratorMethod::kAutomatic}) {
    expectEnd<8>(Hires{}, 321.8122, {1, 0, 0, 0, 0, 0, 0, 0.0057}, {.method = method},
                 {0.7371312573325668e-3, 0.1442485726316185e-3, 0.5888729740967575e-4, 0.1175651343283149e-2,
                  0.2386356198831331e-2, 0.6238968252742796e-2, 0.2849998395185769e-2, 0.2850001604814231e-2},
                 1e-5);
  }
}

TEST(Stiff, StopsAtItsLimitsAndReportsIt) {
  const VanDerPol field;
  IntegratorOptions options = {.max_evaluations = 500, .max_steps = 3};
  IntegratorCounters counters;
  Flown flown;
  EXPECT_EQ(flyField(field, {2, 0}, {0, 0}, 0, 1, options, flown, counters), IntegratorStatus::kDone);
  EXPECT_EQ(counters.coarse_calls, 1);
  EXPECT_EQ(counters.stiff_calls, 1);
  EXPECT_LE(counters.evaluations, 2000);
  options.method = IntegratorMethod::kRadau;
  EXPECT_EQ(flyField(field, {2, 0}, {0, 0}, 0, 1, options, flown, counters), IntegratorStatus::kTooManySteps);
  EXPECT_EQ(counters.failed_calls, 1);
}

// The field is nonlinear, and too stiff for the integrator. The body is not thrown, and the call does not
// fail.
TEST(Stiff, ProblemsBeyondTheLimitsAreSolvedCoarsely) {
  struct Cubic : ForceField {
    double stiffness = 1;
    Vec2 acceleration(Vec2 p, Vec2, double) const override {
      return -stiffness * lengthSquared(p) * p + Vec2{0, 1};
    }
  } field;
  for (double k = 1; k < 2e12; k *= 100) {
    field.stiffness = k;
    for (const int most : {1, 8000}) {
      const IntegratorOptions options = {.max_evaluations = most,
                                         .max_steps = most == 1 ? 16 : IntegratorOptions().max_steps};
      Flyer its = {{1, 0}, {0.1, 0.2}};
      const auto energy = [&] {
        const double square = lengthSquared(its.p);
        return 0.5 * lengthSquared(its.v) + 0.25 * k * square * square - its.p.y;
      };
      const double start = energy();
      for (int i = 0; i < 30; ++i) {
        its.counters = {};
        its.fly(field, i, 1, options);
        EXPECT_LE(its.counters.evaluations, most == 1 ? 400 : 18'000) << k;
        ASSERT_LE(energy(), start * (1 + 1e-3) + 1) << k << ' ' << most << ' ' << i;
      }
    }
  }
}

// Calls in between, or calls in another order, do not change the result.
TEST(Stiff, KeepsNoStateBetweenCalls) {
  VanDerPol field;
  IntegratorCounters counters;
  Flown first, between, again;
  flyField(field, {2, 0}, {-0.5, 0}, 0, 0.1, {}, first, counters);
  flyField(field, {-1, 3}, {1, 0.1}, 7, 0.01, {}, between, counters);
  flyField(field, {2, 0}, {-0.5, 0}, 0, 0.1, {}, again, counters);
  EXPECT_EQ(first.displacement, again.displacement);
  EXPECT_EQ(first.velocity, again.velocity);
}

TEST(Flight, AllocatesNothing) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  const ElasticField soft(10, 0.1, 1, {0, 1}), stiff(1e10, 1e5, 1, {0, 1});
  IntegratorCounters counters;
  Flown flown;
  bool is_done = true;
  const auto before = naiad::test::allocationsSoFar();
  flown = flySpring({1, 2}, {3, 4}, {0, 1}, {1e6, 10}, 1);
  flown = flySpring({}, flown.velocity, {0, 1}, {0, 0.3}, 1);
  is_done &= flyQuadraticDrag({1, 2}, {0, 1}, 0.1, 1, flown, counters) == IntegratorStatus::kDone;
  for (int method = 0; method <= static_cast<int>(IntegratorMethod::kRadau); ++method) {
    const IntegratorOptions options = {.method = static_cast<IntegratorMethod>(method)};
    is_done &= flyField(soft, {1, 0.5}, {}, 0, 1, options, flown, counters) == IntegratorStatus::kDone;
  }
  is_done &= flyField(stiff, {1, 0}, {}, 0, 0.1, {}, flown, counters) == IntegratorStatus::kDone;
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
  EXPECT_TRUE(is_done);
  EXPECT_GT(counters.stiff_calls, 0);
}

}  // namespace
}  // namespace naiad::physics
