// Problem 19: bodies that meet in a point or touch from the start.
#include <cmath>
#include <numbers>
#include <string>

#include "Path.h"
#include "shared/values/SplitMix64.h"

namespace lab {
namespace {

constexpr double kHalf = 0.5;    // half a box's side
constexpr double kApproach = 3;  // m/s; a tenth of a cell per tick

// Impacts must not change the momentum or add energy.
Case meeting(const std::string& name, Scene scene) {
  Case met(name, "", std::move(scene));
  met.most_substeps = 16;
  met.metrics = {{"momentum", "largest change of the momentum, relative", 1e-12, 1e-16},
                 {"energy_gain", "largest gain of energy, relative", 1e-12, 1e-16}};
  met.judge = [scene = met.scene](const Trial& trial) {
    const Whole start = motionOf(scene, *trial.build(scene));
    return trial.largest(scene, [&](int /*tick*/, const Simulation& simulation) {
      const Whole now = motionOf(scene, simulation);
      return std::vector<double>{length(now.momentum - start.momentum) / start.sum,
                                 now.energy / start.energy - 1};
    });
  };
  return met;
}

// Boxes placed evenly on a circle, moving towards its centre.
Scene inwards(int count, double radius, double first_angle) {
  Scene scene;
  scene.ticks = 60;
  for (int i = 0; i < count; ++i) {
    const double angle = first_angle + 2 * std::numbers::pi * i / count;
    const Vec out = {std::cos(angle), std::sin(angle)};
    scene.bodies.push_back(box(radius * out, {kHalf, kHalf}));
    scene.bodies.back().velocity = -kApproach * out;
  }
  return scene;
}

// Touching circles in a row, each heavier than the one before.
Scene heavierAndHeavier() {
  constexpr int kCount = 100;
  constexpr double kHeaviest = 4;  // the last circle's mass is 10 to this power
  Scene scene;
  scene.ticks = 120;
  for (int i = 0; i < kCount; ++i) {
    scene.bodies.push_back(
        ball({static_cast<double>(i), 0}, {}, kHalf, std::pow(10, kHeaviest * i / (kCount - 1))));
    scene.bodies.back().restitution = 1;
  }
  scene.bodies.front().velocity = {kApproach, 0};
  return scene;
}

// Boxes next to and on top of each other, each with its own velocity.
Scene block(int side, std::uint64_t seed) {
  constexpr double kFastest = 0.6;  // limit of a box's speed on each axis, m/s
  naiad::SplitMix64 random(seed);
  Scene scene;
  scene.ticks = 60;
  for (int i = 0; i < side * side; ++i) {
    scene.bodies.push_back(
        box({static_cast<double>(i % side), static_cast<double>(i / side)}, {kHalf, kHalf}));
    const double x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
    scene.bodies.back().velocity = kFastest * Vec{x, y};
  }
  return scene;
}

// Four boxes that meet in a point, 150 from a circle of 30 m, blocks of 2 × 2 and 3 × 3 boxes that touch and
// have velocities of their own, and 100 circles in a row that touch, of 1 to 10⁴ kg, the first at 3 m/s and e
// = 1. No gravity, and boxes do not turn. Correct: momentum stays, and no impact gives energy.
std::vector<Case> makeMeetings() {
  constexpr double kDiagonal = 0.25 * std::numbers::pi;
  std::vector<Case> cases = {meeting("point4", inwards(4, 3 * std::numbers::sqrt2, kDiagonal)),
                             meeting("point150", inwards(150, 30, 0)), meeting("block2", block(2, 1)),
                             meeting("block3", block(3, 2)), meeting("cradle100", heavierAndHeavier())};
  const char* labels[] = {"4 boxes in a point", "150 boxes in a point", "2 × 2 boxes", "3 × 3 boxes",
                          "100 circles in a row"};
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i].label = labels[i];
  cases[1].scene.ticks = 300;
  cases[1].long_run = true;
  return cases;
}

const RegisteredProblem meetings("19", "meetings", makeMeetings, "Many that meet at once",
                                 "Four crates that meet in a corner are the first thing that happens in a "
                                 "game; no tick may take a second for it.");

}  // namespace
}  // namespace lab
