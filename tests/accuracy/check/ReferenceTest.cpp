// The references agree with each other and with published results.
#include <gtest/gtest.h>

#include <cmath>

#include "Problem.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr double kAgree = 1e-9;

// Returns the largest difference over the run, relative to the largest value of each coordinate.
double difference(const Trajectory& a, const Trajectory& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a[0].size(); ++i) {
    double scale = 0;
    double apart = 0;
    for (std::size_t tick = 0; tick < a.size(); ++tick) {
      scale = std::max(scale, std::abs(a[tick][i]));
      apart = std::max(apart, std::abs(a[tick][i] - b[tick][i]));
    }
    if (scale > 0) worst = std::max(worst, apart / scale);
  }
  return worst;
}

// CVODE controls the error of each step, not of the whole run, so growing errors need a smaller tolerance.
CvodeOptions sharp(bool stiff) {
  CvodeOptions options;
  options.stiff = stiff;
  options.relative = 1e-13;
  options.absolute = 1e-17;
  return options;
}

// Compares only the coordinate, not the speed, which jumps by 1e6 within 1e-6 s.
TEST(Reference, SolversAgreeOnVanDerPolAndPublishedResult) {
  const auto equations = equationsOf(VanDerPol());
  const Trajectory exact = equations->byExtrapolation(kTick, 60, Stiffness::STIFF);
  const Trajectory other = equations->byCvode(kTick, 60, sharp(true));
  for (std::size_t tick = 0; tick < exact.size(); ++tick)
    EXPECT_NEAR(exact[tick][0], other[tick][0], 2 * kAgree);
  // Published by the "Test Set for Initial Value Problem Solvers" for its problem VDPOL.
  EXPECT_NEAR(exact.back()[0], 1.706167732170483, 1e-12);
  EXPECT_NEAR(exact.back()[1], -0.8928097010247975, 1e-12);
}

TEST(Reference, SolversAgreeOnHiresAndPublishedResult) {
  constexpr double kEnd = 321.8122;
  constexpr int kTicks = 20;
  const auto equations = equationsOf(Hires());
  const Trajectory exact = equations->byExtrapolation(kEnd / kTicks, kTicks, Stiffness::STIFF);
  EXPECT_LT(difference(exact, equations->byCvode(kEnd / kTicks, kTicks, sharp(true))), kAgree);
  // Published by the "Test Set for Initial Value Problem Solvers" for its problem HIRES.
  const double published[] = {0.7371312573325668e-3, 0.1442485726316185e-3, 0.5888729740967575e-4,
                              0.1175651343283149e-2, 0.2386356198831331e-2, 0.6238968252742796e-2,
                              0.2849998395185769e-2, 0.2850001604814231e-2};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(exact.back()[i] / published[i], 1, 1e-11);
}

// A method that shows CVODE's solution of a scene's equations, to be judged by each problem's own reference.
class Replay : public Simulation {
 public:
  Replay(const Scene& scene, bool stiff)
      : m_equations(scene.equations), m_path(m_equations->byCvode(scene.tick, scene.ticks, sharp(stiff))) {}
  void step(double, int) override { ++m_tick; }
  BodyState body(int index) const override { return m_equations->body(index, m_path[m_tick].data()); }
  std::span<const double> coordinates() const override { return m_path[m_tick]; }

 private:
  std::shared_ptr<const Equations> m_equations;
  Trajectory m_path;
  std::size_t m_tick = 0;
};

TEST(Reference, CvodeMatchesTheReferenceOfEveryEquationProblem) {
  int judged = 0;
  for (const Problem& problem : Problem::all()) {
    // Skips maps, which repeat problem 4, and the pendulum, whose reference is its own energy.
    if (problem.id.size() > 2 || problem.id == "5") continue;
    for (const Case& its_case : problem.make()) {
      if (its_case.scene.equations == nullptr) continue;
      // Skips a phase of a million radians, whose formula other stiffnesses test, and a speed that jumps,
      // which has a test of its own.
      if (its_case.name.starts_with("k1e10") || its_case.name == "van_der_pol") continue;
      const bool stiff = problem.id == "4" || problem.id == "4b";
      const Method method{"cvode", "CVODE", "6", Method::Kind::CANDIDATE,
                          [stiff](const Scene& scene) { return std::make_unique<Replay>(scene, stiff); }};
      const std::vector<double> errors = its_case.judge(Trial(method, 1));
      // CVODE's errors add up over 10,000 radians or 20 close passes of the sun.
      const bool long_phase = its_case.name == "k1e6_zeta0" || its_case.name == "kepler";
      EXPECT_LT(errors[0], long_phase ? 1e-6 : kAgree) << problem.id << ' ' << its_case.name;
      ++judged;
    }
  }
  EXPECT_EQ(judged, 1 + 2 + 3 + 8 + 4 + 2);
}

// Compares derivatives by dual numbers with finite differences, for the equations with most kinds of
// operations.
TEST(Reference, JacobianMatchesFiniteDifferences) {
  DoublePendulum system;
  const double y[] = {0.3, -1.1, 2.0, 0.7};
  const auto jacobian = jacobianOf(system, 0, y);
  constexpr double kStep = 1e-6;
  for (std::size_t column = 0; column < 4; ++column) {
    double more[4];
    double less[4];
    double at_more[] = {y[0], y[1], y[2], y[3]};
    double at_less[] = {y[0], y[1], y[2], y[3]};
    at_more[column] += kStep;
    at_less[column] -= kStep;
    system.rate(0.0, at_more, more);
    system.rate(0.0, at_less, less);
    for (std::size_t row = 0; row < 4; ++row) {
      EXPECT_NEAR(jacobian[row][column], (more[row] - less[row]) / (2 * kStep), 1e-7);
    }
  }
}

}  // namespace
}  // namespace lab
