// Pendulums, compared with the period by Gauss's mean; double pendulums, compared with equations for the
// angles.
#include <gtest/gtest.h>

#include <array>

#include "JointScene.h"

namespace naiad::physics {
namespace {

using test::JointScene;
using test::kDown;
using test::kTick;

JointScene pendulum() {
  JointScene scene = test::nailed();
  scene.point({1, 0});
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.connect();
  return scene;
}

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

// Times of the first and last crossing of the vertical to the left, and their number. Between two ticks, it
// interpolates by the cubic of their places and velocities.
struct Crossings {
  double first = 0, last = 0;
  int count = 0;
};

Crossings crossingsOf(JointScene& scene, int ticks, JointOptions options) {
  Crossings found;
  for (int i = 0; i < ticks; ++i) {
    const double x0 = scene.at(1).x, v0 = scene.body(1).velocity.x * kTick;
    scene.step(kDown, options);
    const double x1 = scene.at(1).x, v1 = scene.body(1).velocity.x * kTick;
    if (!(x0 > 0 && x1 <= 0)) continue;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double s = 0.5 * (low + high), r = 1 - s;
      const double x = x0 * r * r * (1 + 2 * s) + v0 * s * r * r + x1 * s * s * (3 - 2 * s) - v1 * s * s * r;
      (x > 0 ? low : high) = s;
    }
    found.last = (i + low) * kTick;
    if (found.count++ == 0) found.first = found.last;
  }
  return found;
}

TEST(JointPendulum, KeepsEnergyAndLengthForAMinute) {
  JointScene scene = pendulum();
  const double scale = 10;  // m·g·L
  double drift = 0, stretch = 0;
  for (int i = 0; i < 1800; ++i) {
    ASSERT_EQ(scene.step(kDown), 0);
    drift = std::max(drift, std::abs(scene.energy(kDown)) / scale);
    stretch = std::max(stretch, scene.worstGap());
  }
  EXPECT_LE(drift, 1e-4);
  EXPECT_LE(drift, 1e-5);  // the result of the present method
  EXPECT_LE(stretch, 1e-10);
  EXPECT_EQ(scene.solver.counters().refined, 0u);
  EXPECT_LE(scene.solver.counters().stages, 1800u * 8);
}

TEST(JointPendulum, PeriodMatchesTheFormula) {
  JointScene scene = pendulum();
  const Crossings found = crossingsOf(scene, 1800, {});
  ASSERT_GT(found.count, 20);
  const double period = (found.last - found.first) / (found.count - 1);
  EXPECT_NEAR(period / periodOf(1, 10, std::acos(-1.0) / 2), 1, 1e-5);
}

TEST(JointPendulum, MethodsConvergeWithTheirOrder) {
  const auto drift = [](JointMethod method, int substeps) {
    JointScene scene = pendulum();
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
      scene.step(kDown, {method, substeps});
      worst = std::max(worst, std::abs(scene.energy(kDown)));
    }
    return worst;
  };
  const std::array<std::pair<JointMethod, int>, 3> methods = {
      {{JointMethod::kRattle, 2}, {JointMethod::kSuzuki4, 4}, {JointMethod::kKahanLi6, 6}}};
  for (const auto& [method, order] : methods) {
    const int stages = static_cast<int>(stagesOf(method).size());
    double sum = 0;
    for (const double stage : stagesOf(method)) sum += stage;
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_NEAR(std::log2(drift(method, stages) / drift(method, 2 * stages)), order, 0.5) << stages;
  }
}

TEST(JointPendulum, HingedRigidBodyHasAPhysicalPendulumsPeriod) {
  JointScene scene = test::nailed();
  scene.rigid({1, 0}, 2, 0.5);  // I/m·r + r = 1.25 is the equivalent length
  scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  scene.connect();
  double drift = 0;
  JointScene copy = scene;
  for (int i = 0; i < 1800; ++i) {
    copy.step(kDown);
    drift = std::max(drift, std::abs(copy.energy(kDown)) / 20);
    ASSERT_LE(copy.worstGap(), 1e-10);
  }
  EXPECT_LE(drift, 1e-4);
  const Crossings found = crossingsOf(scene, 1800, {});
  ASSERT_GT(found.count, 20);
  const double period = (found.last - found.first) / (found.count - 1);
  EXPECT_NEAR(period / periodOf(1.25, 10, std::acos(-1.0) / 2), 1, 1e-5);
}

// A double pendulum of equal masses on equal rods, computed by its angles with Runge–Kutta of order 4 in long
// double.
std::array<double, 4> doublePendulum(double time, int steps) {
  using State = std::array<long double, 4>;
  const auto rate = [](const State& s) {
    const long double d = s[0] - s[1], g = 10, sine = std::sin(d), cosine = std::cos(d),
                      below = 2 - cosine * cosine;
    const long double first = -2 * g * std::sin(s[0]) - sine * s[3] * s[3];
    const long double second = -g * std::sin(s[1]) + sine * s[2] * s[2];
    return State{s[2], s[3], (first - cosine * second) / below, (2 * second - cosine * first) / below};
  };
  const auto moved = [](const State& s, const State& k, long double h) {
    return State{s[0] + h * k[0], s[1] + h * k[1], s[2] + h * k[2], s[3] + h * k[3]};
  };
  const long double h = static_cast<long double>(time) / steps, quarter = std::acos(-1.0L) / 2;
  State s = {quarter, quarter, 0, 0};
  for (int i = 0; i < steps; ++i) {
    const State k1 = rate(s), k2 = rate(moved(s, k1, h / 2)), k3 = rate(moved(s, k2, h / 2));
    const State k4 = rate(moved(s, k3, h));
    for (std::size_t n = 0; n < 4; ++n) s[n] += h / 6 * (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]);
  }
  return {static_cast<double>(s[0]), static_cast<double>(s[1]), static_cast<double>(s[2]),
          static_cast<double>(s[3])};
}

double doublePendulumError(JointOptions options, double* drift) {
  JointScene scene = test::nailed();
  scene.point({1, 0});
  scene.point({2, 0});
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.join(JointKind::kDistance, 1, 2, 1);
  scene.connect();
  *drift = 0;
  for (int i = 0; i < 150; ++i) {
    scene.step(kDown, options);
    *drift = std::max(*drift, std::abs(scene.energy(kDown)) / 30);
    EXPECT_LE(scene.worstGap(), 1e-10);
  }
  const std::array<double, 4> end = doublePendulum(5, 100000);
  const Vec2 elbow = {std::sin(end[0]), std::cos(end[0])};
  return length(scene.at(2) - (elbow + Vec2{std::sin(end[1]), std::cos(end[1])}));
}

TEST(JointPendulum, DoublePendulumMatchesTheAngleEquations) {
  double drift = 0;
  const double by_default = doublePendulumError({}, &drift);
  EXPECT_LE(by_default, 1e-2);
  EXPECT_LE(drift, 1e-4);
  RecordProperty("default", std::to_string(by_default));
  EXPECT_LE(doublePendulumError({JointMethod::kKahanLi6, 9 * 16}, &drift), 1e-7);
  EXPECT_LE(drift, 1e-10);
}

// Pendulums of one length swing equally to the last bit, whatever else swings, as a cradle requires.
TEST(JointPendulum, EqualPendulumsStayInStep) {
  JointScene scene;
  for (int i = 0; i < 5; ++i) {
    scene.point({static_cast<double>(i), 0}, 0);
    scene.point({i - 3.0, 4});  // whole numbers, so that all pendulums start with equal bits
    scene.join(JointKind::kDistance, 2 * i, 2 * i + 1, 5);
  }
  scene.connect();
  ASSERT_EQ(scene.solver.islands().size(), 5u);
  for (int i = 0; i < 300; ++i) scene.step(kDown);
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(scene.body(2 * i + 1).velocity, scene.body(1).velocity);
    EXPECT_EQ(scene.body(2 * i + 1).place - scene.body(1).place, (Vec2{static_cast<double>(i), 0}));
  }
  EXPECT_LE(scene.worstGap(), 1e-10);
}

}  // namespace
}  // namespace naiad::physics
