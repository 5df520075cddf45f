// Problem 9: a stack. Problem 10: a heavy body on a light one, and a stability map. Problem 20: crates that
// stand a little to the side of each other.
#include <algorithm>

#include "Path.h"

namespace lab {
namespace {

constexpr double kHalf = 0.5;
constexpr double kFriction = 0.5;
constexpr double kGravity = 10;
constexpr int kTicks = 300;  // 10 s
constexpr double kGone = 2;  // sideways distance in metres at which a crate is no longer on another

Scene stackOf(const std::vector<double>& masses, bool rotates) {
  Scene scene;
  scene.bodies = {ground(100, kFriction)};
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vec place{0, kHalf + 2 * kHalf * static_cast<double>(i)};
    scene.bodies.push_back(crate(place, {kHalf, kHalf}, kFriction, masses[i]));
    scene.bodies.back().rotates = rotates;
  }
  scene.gravity = {0, -kGravity};
  scene.ticks = kTicks;
  return scene;
}

double sagOf(const Scene& scene, const Simulation& simulation) {
  double sag = 0;
  for (int i = 1; i < static_cast<int>(scene.bodies.size()); ++i) {
    const double right = scene.bodies[static_cast<std::size_t>(i)].position.y;
    sag = std::max(sag, std::abs(simulation.body(i).position.y - right));
  }
  return sag;
}

struct Heap {
  double sag = 0;  ///< largest distance from the correct height over the run
  double top = 0;  ///< final height of the uppermost crate, relative to the correct one
};

Heap settle(const Trial& trial, const Scene& scene) {
  Heap heap;
  const SimulationPtr end = trial.run(scene, [&](int, const Simulation& simulation) {
    heap.sag = std::max(heap.sag, sagOf(scene, simulation));
  });
  const int top = static_cast<int>(scene.bodies.size()) - 1;
  heap.top = end->body(top).position.y / scene.bodies.back().position.y;
  return heap;
}

Case stack(int boxes, bool rotates, double target) {
  Case standing(std::to_string(boxes) + (rotates ? "" : "_upright"), "",
                stackOf(std::vector<double>(static_cast<std::size_t>(boxes), 1), rotates));
  standing.long_run = boxes > 30;
  standing.draws_levels = true;
  standing.label = std::to_string(boxes) + (rotates ? " crates" : " crates that do not turn");
  standing.metrics = {{"sag_m", "largest error of a height over 10 s, m", target, 1e-15}};
  standing.judge = [scene = standing.scene](const Trial& trial) {
    const Heap heap = settle(trial, scene);
    if (heap.top < 0.5) throw Failure("collapsed");
    return std::vector<double>{heap.sag};
  };
  return standing;
}

// 10, 30 and 100 crates of 1 m on each other, gaps exactly 0 at the start, friction 0.5, 10 s; none sleeps.
// `upright`: bodies that do not rotate. Correct: nothing moves.
std::vector<Case> makeStack() {
  return {stack(10, true, 1e-3),  stack(30, true, 1e-2),  stack(100, true, 0.1),
          stack(10, false, 1e-9), stack(30, false, 1e-9), stack(100, false, 1e-9)};
}

// Measures the deepest overlap of the two contacts in the last second. A crate that fell off is a failure.
Case press(double ratio) {
  Case pressed("ratio" + power(ratio));
  pressed.x = ratio;
  pressed.draws_levels = true;
  pressed.label = "1 : " + power(ratio);
  pressed.scene = stackOf({1, ratio}, true);
  pressed.judge = [scene = pressed.scene](const Trial& trial) {
    return trial.largest(scene, [&](int tick, const Simulation& simulation) {
      if (tick <= scene.ticks - 30) return std::vector<double>{0};
      const Vec light = simulation.body(1).position;
      const Vec heavy = simulation.body(2).position;
      const double below = kHalf - light.y;
      const double between = 2 * kHalf - (heavy.y - light.y);
      if (std::abs(heavy.x) > kGone || std::abs(light.x) > kGone) throw Failure("fell off");
      return std::vector<double>{std::max(below, between)};
    });
  };
  return pressed;
}

// A crate of R kg on one of 1 kg on the ground, gaps 0 at the start, friction 0.5, 10 s. Correct: nothing
// moves; the metric is the deepest overlap in the last second.
std::vector<Case> makePress() {
  std::vector<Case> cases;
  for (const double ratio : {10.0, 100.0, 1e3, 1e4}) {
    Case pressed = press(ratio);
    pressed.metrics = {{"penetration_m", "deepest overlap in the last second, m", 1e-6, 1e-15}};
    cases.push_back(pressed);
  }
  return cases;
}

// The two crates of problem 10. A cell is the deepest overlap in the last second, in halves of a crate: from
// 1 on the light one is crushed. Correct: nothing moves.
std::vector<Case> makeMap() {
  return mapOf(1e6, press, {"penetration", "mass ratio", -1, 0}, kHalf);
}

Case offset(int boxes) {
  constexpr double kShift = 0.025;  // sideways distance of neighbouring crates, m
  constexpr double kMoreFriction = 0.6;
  Case standing(std::to_string(boxes), std::to_string(boxes) + " crates",
                stackOf(std::vector<double>(static_cast<std::size_t>(boxes), 1), true));
  for (std::size_t i = 0; i < standing.scene.bodies.size(); ++i) {
    standing.scene.bodies[i].friction = kMoreFriction;
    if (i > 0) standing.scene.bodies[i].position.x = i % 2 == 1 ? kShift : -kShift;
  }
  standing.most_substeps = 16;
  standing.draws_levels = true;
  standing.metrics = {{"sag_m", "largest error of a height over 10 s, m", 0.05, 1e-15}};
  standing.judge = [scene = standing.scene](const Trial& trial) {
    return trial.largest(scene, [&](int /*tick*/, const Simulation& simulation) {
      const double sag = sagOf(scene, simulation);
      if (sag > 0.5) throw Failure("collapsed");
      return std::vector<double>{sag};
    });
  };
  return standing;
}

// 20, 40 and 60 crates of 1 m on each other, in turn 0.025 m to the left and to the right, friction 0.6, 10
// s. Correct: nothing moves.
std::vector<Case> makeOffset() {
  return {offset(20), offset(40), offset(60)};
}

const RegisteredProblem stack_problem("9", "stack", makeStack, "Stack",
                                      "Crates that stand must stand, however many.");
const RegisteredProblem press_problem(
    "10", "mass-ratio", makePress, "Heavy on light",
    "An author gives a tank a thousand times a crate's mass, and drives over it.");
const RegisteredProblem offsets(
    "20", "offset-stack", makeOffset, "A stack to both sides",
    "Stacks are never exact; small offsets add up to a lever of the whole height.");
const RegisteredProblem map("map-mass-ratio", "mass-ratio-map", makeMap,
                            "What stays bounded: mass ratio × step", "", Problem::Kind::MAP);

}  // namespace
}  // namespace lab
