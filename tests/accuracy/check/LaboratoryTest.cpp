// Tests that the laboratory detects what it should: orders, errors, crashes, and missed targets.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "ElapsedTime.h"
#include "Measurement.h"
#include "Records.h"
#include "Systems.h"

namespace lab {
namespace {

Problem problemOf(const std::string& id) {
  const std::vector<Problem> all = Problem::all();
  return *std::ranges::find(all, id, &Problem::id);
}

std::vector<Case> casesOf(const std::string& id) {
  return problemOf(id).make();
}

const Method& methodOf(const std::string& name) {
  for (const Method* method : Method::all()) {
    if (method->name == name) return *method;
  }
  throw std::logic_error("there is no method " + name);
}

Method integrator(Rule rule, Method::Kind kind) {
  return {"planted", "planted", "1", kind,
          [rule](const Scene& scene) { return scene.equations->integrate(rule); }};
}

double errorOf(const Case& its_case, const Method& method, int substeps) {
  return judge(its_case, method, substeps).errors[0];
}

// Returns the order from the phase error at 8 and 16 sub-steps, on an undamped spring of 1 Hz.
double orderOf(const std::string& method) {
  const std::vector<Case> cases = casesOf("3");
  const Case& spring = cases[0];
  const double coarse = judge(spring, methodOf(method), 8).errors[1];
  const double fine = judge(spring, methodOf(method), 16).errors[1];
  return std::log2(coarse / fine);
}

TEST(Laboratory, MethodsConvergeWithTheirOrder) {
  // orderOf() measures the phase, in which semi_implicit has order 2; its positions have order 1.
  for (const char* method : {"semi_implicit", "verlet", "tr_bdf2"})
    EXPECT_NEAR(orderOf(method), 2, 0.1) << method;
  for (const char* method : {"rk4", "yoshida4"}) EXPECT_NEAR(orderOf(method), 4, 0.1) << method;
  const std::vector<Case> flight = casesOf("1");
  for (const char* method : {"euler", "semi_implicit", "backward_euler"}) {
    const double ratio = errorOf(flight[0], methodOf(method), 4) / errorOf(flight[0], methodOf(method), 8);
    EXPECT_NEAR(std::log2(ratio), 1, 0.1) << method;
  }
}

TEST(Laboratory, VerletStaysSecondOrderWithDrag) {
  const std::vector<Case> drag = casesOf("2");
  const double coarse = errorOf(drag[1], methodOf("verlet"), 8);
  const double fine = errorOf(drag[1], methodOf("verlet"), 16);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

// Runs an integrator as if it was the product, with and without an error. The printed lines, the CSV file and
// the exit code must show the error.
TEST(Laboratory, PlantedErrorMissesItsTarget) {
  const Problem problem = problemOf("1");
  const std::vector<Case> cases = problem.make();
  const Case& flight = cases[0];
  for (const bool planted : {false, true}) {
    const Method method =
        integrator(planted ? Rule::PLANTED_ERROR : Rule::RUNGE_KUTTA_4, Method::Kind::PRODUCT);
    const std::string directory = ::testing::TempDir() + "naiad_lab_planted-" + std::to_string(getpid());
    {
      Records records(directory);
      records.describe(problem, cases);
      const Measurement measurement = judge(flight, method, 1);
      records.add(problem, flight, method, 1, measurement);
      EXPECT_EQ(records.allMet(), !planted);
      EXPECT_EQ(measurement.errors[0] > 1e-3, planted);
    }
    std::ifstream file(directory + "/points.csv");
    std::string header;
    std::string first;
    std::getline(file, header);
    std::getline(file, first);
    EXPECT_NE(first.find(planted ? ",1e-12,0," : ",1e-12,1,"), std::string::npos) << first;
  }
}

TEST(Laboratory, CpuTimeIsComparedWithAnotherMethod) {
  const Problem problem = problemOf("5");
  const std::vector<Case> cases = problem.make();
  const Method product = integrator(Rule::VERLET, Method::Kind::PRODUCT);
  const CpuBound bound{"cpu_ratio", "box2d", 4, 0.5};
  Measurement measurement;
  measurement.cpu = {2, 2, 2};
  for (const double compared : {3.0, 5.0}) {
    Records records("");
    records.add(problem, cases[0], bound, product, 1, measurement, 2 / compared);
    EXPECT_EQ(records.allMet(), compared == 5);
  }
}

// Other methods are not judged.
TEST(Laboratory, LevelsAreJudgedByTheirOwnTargetAndSubsteps) {
  const Problem problem = problemOf("1");
  std::vector<Case> cases = problem.make();
  Case& flight = cases[0];
  flight.metrics.resize(1);
  flight.metrics[0].target = 1e-3;
  flight.metrics[0].fast_target = 1e-1;
  Measurement measurement;
  measurement.errors = {1e-2};
  for (const Method::Kind kind : {Method::Kind::PRODUCT, Method::Kind::FAST, Method::Kind::TEXTBOOK}) {
    Method level = integrator(Rule::VERLET, kind);
    level.own_substeps = 4;
    for (const int substeps : {4, 8}) {
      Records records("");
      records.add(problem, flight, level, substeps, measurement);
      EXPECT_EQ(records.allMet(), kind != Method::Kind::PRODUCT || substeps == 8) << substeps;
    }
  }
}

// Uses 3 ms of CPU time in its third tick.
class Stumbling : public Simulation {
 public:
  explicit Stumbling(double impacts) : m_impacts(impacts) {}
  void step(double, int) override {
    if (++m_tick != 3) return;
    const double start = bench::cpuNanoseconds();
    while (bench::cpuNanoseconds() - start < 3e6) {
    }
  }
  BodyState body(int) const override { return {}; }
  std::optional<Work> work() const override { return Work{0, m_tick < 3 ? 0 : m_impacts}; }

 private:
  double m_impacts;
  int m_tick = 0;
};

TEST(Laboratory, SlowestTickIsJudgedByItsTimeLimit) {
  const Problem problem = problemOf("1");
  const std::vector<Case> cases = problem.make();
  Case flight = cases[0];
  flight.metrics.clear();
  flight.judge = [](const Trial&) { return std::vector<double>(); };
  for (const double impacts : {0.0, 10'000.0}) {
    const Method method{"stumbling", "stumbling", "1", Method::Kind::PRODUCT,
                        [=](const Scene&) { return std::make_unique<Stumbling>(impacts); }};
    const Measurement measurement = measureApart(flight, method, 1, 1, 60);
    EXPECT_GE(measurement.cpu.worst, 3000);
    Records records("");
    records.add(problem, flight, method, 1, measurement);
    EXPECT_EQ(records.allMet(), impacts > 0) << measurement.cpu.worst_part;
  }
}

TEST(Laboratory, TickTimeLimitGrowsWithBodiesAndImpacts) {
  const TickBound bound;
  EXPECT_EQ(bound.allowedUs(0, 0, 0, 0), 1000);
  EXPECT_EQ(bound.allowedUs(100, 200, 50, 300), 1000 + 5 * 350 + 300);
  EXPECT_EQ(bound.allowedUs(2, 0, 0, 1e9), 1000 + 10 + 20'000);  // only 20,000 impacts count
}

TEST(Laboratory, DivergingMethodFailsWithAReason) {
  const std::vector<Case> cases = casesOf("4");
  const Case& stiffest = cases.back();
  const Measurement measurement = judge(stiffest, methodOf("euler"), 1);
  EXPECT_TRUE(std::isinf(measurement.errors[0]));
  EXPECT_EQ(measurement.reason, "blew up");
}

class Aborting : public Simulation {
 public:
  void step(double, int) override { std::abort(); }
  BodyState body(int) const override { return {}; }
};

class Endless : public Simulation {
 public:
  void step(double, int) override {
    for (volatile bool go_on = true; go_on;) {
    }
  }
  BodyState body(int) const override { return {}; }
};

template <class Simulated>
Method methodThatIs() {
  return {"bad", "bad", "1", Method::Kind::PEER, [](const Scene&) { return std::make_unique<Simulated>(); }};
}

TEST(Laboratory, CrashingOrEndlessMethodIsReportedAsFailure) {
  const std::vector<Case> cases = casesOf("1");
  const Measurement crash = measureApart(cases[0], methodThatIs<Aborting>(), 1, 1, 1);
  EXPECT_EQ(crash.reason, "crashed by signal 6");
  EXPECT_TRUE(std::isinf(crash.errors[0]));
  EXPECT_TRUE(std::isnan(crash.cpu.median));
  const Measurement loop = measureApart(cases[0], methodThatIs<Endless>(), 1, 1, 1);
  EXPECT_EQ(loop.reason, "took too long");
  EXPECT_TRUE(std::isinf(loop.errors[1]));
}

TEST(Laboratory, SeparateProcessMeasuresTheSameErrors) {
  const std::vector<Case> cases = casesOf("5");
  const Measurement here = judge(cases[0], methodOf("verlet"), 2);
  const Measurement apart = measureApart(cases[0], methodOf("verlet"), 2, 1, 60);
  EXPECT_EQ(here.errors, apart.errors);
  EXPECT_GT(apart.cpu.median, 0);
  EXPECT_LE(apart.cpu.least, apart.cpu.median);
}

TEST(Laboratory, MethodThatIsNotTimedHasNoTimes) {
  Method method = integrator(Rule::VERLET, Method::Kind::PEER);
  method.is_timed = false;
  const Measurement measurement = measureApart(casesOf("5")[0], method, 2, 1, 60);
  EXPECT_TRUE(std::isnan(measurement.cpu.median));
  EXPECT_LT(measurement.errors[0], 1);
  EXPECT_EQ(measurement.reason, "");
}

TEST(Laboratory, SceneUnsupportedByTheMethodIsReported) {
  const std::vector<Case> cases = casesOf("8");
  EXPECT_FALSE(measureApart(cases[0], methodOf("rk4"), 1, 1, 10).expressed);
  EXPECT_TRUE(measureApart(cases[0], methodOf("box2d"), 1, 1, 10).expressed);
}

void expectStart(const Scene& scene, const Simulation& simulation, double tolerance,
                 const std::string& what) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const BodyState state = simulation.body(static_cast<int>(i));
    EXPECT_LT(length(state.position - body.position), tolerance) << what << ' ' << i;
    EXPECT_LT(length(state.velocity - body.velocity), tolerance) << what << ' ' << i;
  }
}

// Every engine must start from exactly the scene's state.
TEST(Laboratory, PeerEnginesStartFromTheSceneState) {
  for (const char* id : {"1", "5", "7", "8", "9", "11", "12", "17", "25", "27"}) {
    for (const Case& its_case : casesOf(id)) {
      for (const Method* method : Method::all()) {
        if (method->kind != Method::Kind::PEER) continue;
        const SimulationPtr simulation = method->build(its_case.scene);
        if (simulation == nullptr) continue;
        expectStart(its_case.scene, *simulation, 1e-5, method->name + ' ' + id);
        for (std::size_t i = 0; i < its_case.scene.bodies.size(); ++i) {
          const double angle = simulation->body(static_cast<int>(i)).angle;
          EXPECT_NEAR(angle, its_case.scene.bodies[i].angle, 1e-6) << id << ' ' << method->name << ' ' << i;
        }
      }
    }
  }
}

// The engines' errors of free flight, drag, a soft spring, friction and rolling are those of their
// integrators.
TEST(Laboratory, EnginesFromNpmMoveTheScenesRightly) {
  for (const char* name : {"box2d3", "rapier"}) {
    const std::vector<const Method*> methods = Method::all();
    const auto found = std::ranges::find(methods, name, &Method::name);
    if (found == methods.end()) GTEST_SKIP() << "deploy/lab has not fetched " << name << " from npm";
    for (const char* id : {"1", "2", "3", "12", "13"}) {
      for (const Case& its_case : casesOf(id)) {
        if (its_case.name == "5hz" || its_case.name == "15hz") continue;  // the engines damp stiff springs
        const Measurement measured = judge(its_case, **found, 16);
        const std::size_t which = id == std::string("3") ? 1 : 0;  // the phase, not the amplitude
        ASSERT_TRUE(measured.expressed && measured.reason.empty()) << name << ' ' << id << measured.reason;
        EXPECT_LT(measured.errors[which], 0.005) << name << ' ' << id << ' ' << its_case.name;
      }
    }
  }
}

// The equations of the textbooks' methods must start from the scene's state, too.
TEST(Laboratory, EquationsStartFromTheSceneState) {
  for (const char* id : {"1", "2", "3", "4", "5", "6"}) {
    for (const Case& its_case : casesOf(id))
      expectStart(its_case.scene, *methodOf("rk4").build(its_case.scene), 1e-14, id + its_case.name);
  }
}

}  // namespace
}  // namespace lab
