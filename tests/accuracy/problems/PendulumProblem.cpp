// Problem 5: a pendulum released at 90°, for a minute.
#include <algorithm>

#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr int kTicks = 1800;
constexpr double kGravity = 10;
constexpr double kStart = M_PI / 2;

// A point on a rod of 1 m starts at 90° and swings for 60 s under 10 m/s². The textbook methods solve for its
// angle and cannot stretch the rod; engines have a joint. Correct: energy and length stay.
std::vector<Case> make() {
  Case swing;
  swing.scene.bodies = {point({1, 0})};
  swing.scene.joints = {rod(-1, {0, 0}, 0, {1, 0})};
  swing.scene.gravity = {0, -kGravity};
  swing.scene.ticks = kTicks;
  Pendulum system;
  system.gravity = kGravity;
  system.angle = kStart;
  swing.scene.equations = equationsOf(system);
  swing.metrics = {{"energy_drift", "largest |ΔE| / mgL", 1e-4, 1e-15},
                   {"length", "largest relative error of the length", 1e-10, 1e-16}};
  swing.cpu_bounds = {{"cpu_ratio", "box2d", 4, 1.0 / 15}};
  swing.judge = [scene = swing.scene](const Trial& trial) {
    double worst_energy = 0, worst_length = 0;
    trial.run(scene, [&](int /*tick*/, const Simulation& simulation) {
      const BodyState state = simulation.body(0);
      // The pendulum starts at rest and horizontally, so its energy is 0. The error is relative to g ×
      // length, the range of its potential energy.
      const double energy = dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y;
      worst_energy = std::max(worst_energy, std::abs(energy) / kGravity);
      worst_length = std::max(worst_length, std::abs(length(state.position) - 1));
    });
    return std::vector<double>{worst_energy, worst_length};
  };
  return {swing};
}

const RegisteredProblem problem("5", "pendulum", make, "Pendulum",
                                "A lamp on a chain must not come to rest by itself, and must cost little.");

}  // namespace
}  // namespace lab
