// Pendulums, compared with the period by Gauss's mean; double pendulums, compared with equations for the
// angles.
#include <gtest/gtest.h>

#include "JointScene.h"
#include "tests/server/physics/QuadReference.h"

namespace naiad::physics {
namespace {

using namespace test;

// Returns the period 4·√(L/g)·K(sin(θ₀/2)), with K by the arithmetic-geometric mean.
double periodOf(double length, double g, double start) {
  __float128 a = 1, b = std::cos(start / 2);
  for (int i = 0; i < 10; ++i) {
    const __float128 mean = (a + b) / 2;
    b = static_cast<__float128>(std::sqrt(static_cast<long double>(a * b)));
    a = mean;
  }
  return 2 * std::acos(-1.0) * std::sqrt(length / g) / static_cast<double>(a);
}

struct Swing {
  double first = 0, last = 0;      // times of the first and last crossing of the vertical to the left
  int crossings = 0;               // their number
  double energy = 0, stretch = 0;  // maxima of |energy| and of the joints' errors
};

// Between two ticks, interpolates by the cubic of the body's places and velocities.
Swing swingOf(JointScene& scene, int ticks) {
  Swing swing;
  for (int i = 0; i < ticks; ++i) {
    const double x0 = scene.at(1).x, v0 = scene.body(1).velocity.x;
    scene.step(kDown);
    swing.energy = std::max(swing.energy, std::abs(scene.energy(kDown)));
    swing.stretch = std::max(swing.stretch, scene.worstGap());
    const double x1 = scene.at(1).x, v1 = scene.body(1).velocity.x;
    if (!(x0 > 0 && x1 <= 0)) continue;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double s = 0.5 * (low + high), r = 1 - s;
      const double x = x0 * r * r * (1 + 2 * s) + v0 * s * r * r + x1 * s * s * (3 - 2 * s) - v1 * s * s * r;
      (x > 0 ? low : high) = s;
    }
    swing.last = (i + low) * kTick;
    if (swing.crossings++ == 0) swing.first = swing.last;
  }
  return swing;
}

TEST(RigidPendulum, KeepsEnergyLengthAndPeriodForAMinute) {
  for (const bool is_hinged : {false, true}) {
    JointScene scene = nailed();
    if (is_hinged) {
      scene.rigid({1, 0}, 2, 0.5);  // I/m·r + r = 1.25 is the equivalent length
      scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
    } else {
      scene.point({1, 0});
      scene.join(JointKind::kDistance, 0, 1, 1);
    }
    const Swing swing = swingOf(scene, 1800);
    EXPECT_LE(swing.energy / (is_hinged ? 20 : 10), 1e-6) << is_hinged;
    EXPECT_LE(swing.stretch, 1e-10) << is_hinged;
    ASSERT_GT(swing.crossings, 20) << is_hinged;
    const double period = (swing.last - swing.first) / (swing.crossings - 1);
    EXPECT_NEAR(period / periodOf(is_hinged ? 1.25 : 1, 10, std::acos(-1.0) / 2), 1, 1e-5) << is_hinged;
    EXPECT_EQ(scene.world.linkageCounters().refined, 0) << is_hinged;
  }
}

// A pendulum whose angle is limited, far from its limits, is solved by RigidDirect, with fewer sub-steps.
TEST(RigidPendulum, SwingsBetweenAngleLimitsWithoutLoss) {
  JointScene scene = nailed();
  scene.rigid({1, 0}, 2, 0.5);
  scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  Joint limit = jointOf(JointKind::kAngleLimit, 0, 1, {.lower = -3, .upper = 3});
  limit.reference = {0, 1};
  scene.join(limit);
  const Swing swing = swingOf(scene, 1800);
  EXPECT_LE(swing.energy / 20, 1e-3);
  EXPECT_LE(swing.stretch, 1e-6);
  EXPECT_GT(swing.crossings, 20);
}

// Two equal masses on equal rods, released horizontally.
TEST(RigidPendulum, DoublePendulumMatchesTheAngleEquations) {
  const QuadSystem<4> rates = [](Quad, const QuadVector<4>& y) {
    const Quad d = y[0] - y[1], g = 10, sine = sinq(d), cosine = cosq(d), below = 2 - cosine * cosine;
    const Quad first = -2 * g * sinq(y[0]) - sine * y[3] * y[3];
    const Quad second = -g * sinq(y[1]) + sine * y[2] * y[2];
    return QuadVector<4>{y[2], y[3], (first - cosine * second) / below,
                         (2 * second - cosine * first) / below};
  };
  const auto angles = quadSolve<4>(rates, 0, 5, {acosq(0), acosq(0), 0, 0}, 1000);
  const Vec2 end = {static_cast<double>(sinq(angles[0]) + sinq(angles[1])),
                    static_cast<double>(cosq(angles[0]) + cosq(angles[1]))};
  JointScene scene = ropeOf(2, 1);
  for (int i = 0; i < 150; ++i) {
    scene.step(kDown);
    EXPECT_LE(std::abs(scene.energy(kDown)) / 30, 1e-9);
    EXPECT_LE(scene.worstGap(), 1e-10);
  }
  EXPECT_LE(length(scene.at(2) - end), 0.1);
}

// Pendulums of one length swing equally to the last bit, whatever else swings, as a cradle requires.
TEST(RigidPendulum, EqualPendulumsStayInStep) {
  JointScene scene;
  for (int i = 0; i < 5; ++i) {
    scene.point({static_cast<double>(i), 0}, 0);
    scene.point({i - 3.0, 4});  // whole numbers, so that all pendulums start with equal bits
    scene.join(JointKind::kDistance, 2 * i, 2 * i + 1, 5);
  }
  for (int i = 0; i < 300; ++i) scene.step(kDown);
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(scene.velocity(2 * i + 1), scene.velocity(1));
    EXPECT_EQ(scene.body(2 * i + 1).place - scene.body(1).place, (Vec2{static_cast<double>(i), 0}));
  }
  EXPECT_LE(scene.worstGap(), 1e-10);
}

}  // namespace
}  // namespace naiad::physics
