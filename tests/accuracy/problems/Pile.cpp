// Problem 10b: a pyramid that stands, and a rotating drum full of boxes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "Problem.h"
#include "physics/Overlap.h"

namespace lab {
namespace {

constexpr double kFriction = 0.5;
constexpr int kTicks = 300;  // 10 s
constexpr int kRows = 30;
constexpr double kCrate = 0.5;  // half the width of a crate in the pyramid
constexpr int kBoxes = 500;
constexpr double kBox = 0.125;  // half the width of a box in the drum
constexpr double kDrum = 10;    // distance from its centre to each wall, m
constexpr int kFallen = 30;     // ticks until the boxes in the drum have fallen onto each other
constexpr double kOut = 16;     // a box at this distance from the drum's centre, in metres, is outside

// Returns the deepest overlap among all bodies except the first.
double deepest(const Scene& scene, const Simulation& simulation) {
  const std::vector<BodyState> states = statesOf(scene, simulation);
  return deepestOverlap({scene.bodies.begin() + 1, scene.bodies.end()}, {states.begin() + 1, states.end()});
}

Case pyramid() {
  Case standing("pyramid", "a pyramid of 30 rows");
  standing.scene.bodies = {ground(100, kFriction)};
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i) {
      const Vec place{1.1 * (i - 0.5 * (kRows - row - 1)), kCrate + row};
      standing.scene.bodies.push_back(crate(place, {kCrate, kCrate}, kFriction));
    }
  }
  standing.scene.gravity = {0, -10};
  standing.scene.ticks = kTicks;
  standing.most_substeps = 16;
  standing.draws_levels = true;
  standing.metrics = {{"penetration_m", "deepest overlap of two crates at the end, m", 1e-6, 1e-15},
                      {"drift_m", "largest sideways distance after 10 s, m", 1e-6, 1e-15}};
  standing.cpu_bounds = {{"cpu_ratio", "box2d", 4, 1.5}};
  standing.judge = [scene = standing.scene](const Trial& trial) {
    const int count = static_cast<int>(scene.bodies.size());
    const SimulationPtr end = trial.run(scene);
    double drift = 0;
    for (int i = 1; i < count; ++i) {
      const Vec from = scene.bodies[static_cast<std::size_t>(i)].position, to = end->body(i).position;
      if (std::abs(to.y - from.y) > 2) throw Failure("collapsed");
      drift = std::max(drift, std::abs(to.x - from.x));
    }
    return std::vector<double>{deepest(scene, *end), drift};
  };
  return standing;
}

Case tumbler() {
  Case turning("tumbler", "500 boxes in a drum that turns");
  Body drum;
  drum.motion = Motion::KINEMATIC;
  drum.spin = 0.05 * 2 * std::numbers::pi;
  drum.friction = kFriction;
  const Vec flat = {kDrum + 0.5, 0.5}, tall = {0.5, kDrum + 0.5};
  drum.shapes = {{Shape::Kind::BOX, 0, flat, {0, kDrum}},
                 {Shape::Kind::BOX, 0, tall, {kDrum, 0}},
                 {Shape::Kind::BOX, 0, flat, {0, -kDrum}},
                 {Shape::Kind::BOX, 0, tall, {-kDrum, 0}}};
  turning.scene.bodies = {drum};
  for (int i = 0; i < kBoxes; ++i) {
    const Vec place{0.35 * (i % 25 - 12), -0.35 * (i / 25 - 10)};
    turning.scene.bodies.push_back(crate(place, {kBox, kBox}, kFriction));
  }
  turning.scene.gravity = {0, -10};
  turning.scene.ticks = kTicks;
  turning.long_run = true;
  turning.most_substeps = 16;
  turning.draws_levels = true;
  turning.metrics = {
      {"penetration_m", "deepest overlap of two boxes of 0.25 m from the second second on, m", 0.086, 1e-15},
      {"mean_penetration_m", "the deepest overlap of each tick, on average, m", 0.027, 1e-15}};
  turning.cpu_bounds = {{"cpu_ratio", "box2d", 4, 1.5}};
  turning.judge = [scene = turning.scene](const Trial& trial) {
    const int count = static_cast<int>(scene.bodies.size());
    double most = 0, sum = 0;
    const SimulationPtr end = trial.run(scene, [&](int tick, const Simulation& simulation) {
      if (tick <= kFallen) return;
      const double now = deepest(scene, simulation);
      most = std::max(most, now);
      sum += now;
    });
    for (int i = 1; i < count; ++i) {
      const Vec at = end->body(i).position;
      if (dot(at, at) > kOut * kOut) throw Failure("a box got out");
    }
    return std::vector<double>{most, sum / (kTicks - kFallen)};
  };
  return turning;
}

// A pyramid of 30 rows of crates of 1 m (465), 0.1 m apart within a row; and 500 boxes of 0.25 m in a square
// drum of 20 m that turns once in 20 s. Friction 0.5, 10 s; nothing sleeps. Correct: nothing overlaps, and a
// pyramid stays where it is.
std::vector<Case> makePile() {
  return {pyramid(), tumbler()};
}

const RegisteredProblem problem("10b", "pile", makePile, "Piles",
                                "General piles, in which contacts come and go: the error against Box2D's at "
                                "its time, with nothing asleep.");

}  // namespace
}  // namespace lab
