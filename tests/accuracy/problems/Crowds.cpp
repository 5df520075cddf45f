// Problem 24: bodies that receive collision events but push nothing.
#include <cmath>
#include <string>
#include <vector>

#include "Path.h"
#include "shared/values/SplitMix64.h"

namespace lab {
namespace {

constexpr double kRadius = 0.5;
constexpr int kTicks = 60;

// Measures the difference between the numbers of pairs with an event and of pairs that overlap, relative to
// the latter.
Case hearing(const std::string& name, Scene scene, long pairs) {
  Case heard(name, "", std::move(scene));
  heard.scene.hearing = true;
  heard.scene.ticks = kTicks;
  heard.most_substeps = 4;
  heard.metrics = {{"misheard", "pairs that are heard of wrongly, of all", 0, 1e-6}};
  heard.judge = [scene = heard.scene, pairs](const Trial& trial) {
    const SimulationPtr end = trial.run(scene);
    const auto all = static_cast<double>(pairs > 0 ? pairs : 1);
    return std::vector<double>{std::abs(static_cast<double>(end->contacts() - pairs)) / all};
  };
  return heard;
}

Scene grid(int side) {
  constexpr double kApart = 3;  // distance of neighbours, m
  Scene scene;
  for (int i = 0; i < side * side; ++i) {
    scene.bodies.push_back(ball({kApart * (i % side), kApart * (i / side)}, {}, kRadius));
  }
  return scene;
}

// The bodies are those of the case "apart", but HARD. Its time is the reference for that case's.
Case hardApart(int side) {
  Case hard = hearing("hard" + std::to_string(side * side), grid(side), 0);
  hard.label = std::to_string(side * side) + " apart, HARD";
  hard.scene.hearing = false;
  hard.judge = [scene = hard.scene](const Trial& trial) {
    return std::vector<double>{static_cast<double>(trial.run(scene)->contacts())};
  };
  return hard;
}

Case apart(int side) {
  Case soft = hearing("apart" + std::to_string(side * side), grid(side), 0);
  soft.label = std::to_string(side * side) + " apart";
  soft.cpu_bounds = {{.name = "cpu_ratio",
                      .method = "",
                      .target = 1.5,
                      .of_case = "hard" + std::to_string(side * side),
                      .unit_label = "the same bodies, HARD"}};
  return soft;
}

// All bodies overlap each other.
Case together(int count) {
  naiad::SplitMix64 random(24);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const double x = kRadius * random.unit(), y = kRadius * random.unit();
    scene.bodies.push_back(ball({x, y}, {}, kRadius));
  }
  constexpr double kPair = 0.1;  // time limit for a pair, µs
  const long pairs = static_cast<long>(count) * (count - 1) / 2;
  Case soft = hearing("together" + std::to_string(count), scene, pairs);
  soft.label = std::to_string(count) + " together";
  soft.cpu_bounds = {{.name = "time_of_pairs",
                      .method = "",
                      .target = 1,
                      .unit_us = kPair * static_cast<double>(pairs),
                      .unit_label = "100 ns a pair"}};
  return soft;
}

// SOFT bodies, which nothing pushes, for 60 ticks: 1,024 circles of 1 m that are 3 m apart, and 50, 100, 200
// and 400 circles that all overlap each other. The time is compared with that of equal HARD bodies, and with
// 100 ns per pair. Only for the product. Correct: each overlapping pair has one event, in the first tick,
// which is the slowest.
std::vector<Case> make() {
  return {hardApart(32), apart(32), together(50), together(100), together(200), together(400)};
}

const RegisteredProblem problem(
    "24", "crowds", make, "Crowds that hear",
    "Sensors, clouds and triggers lie in one another by hundreds, and must not cost a tick.");

}  // namespace
}  // namespace lab
