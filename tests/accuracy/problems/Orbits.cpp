// Problem 5: a pendulum released at 90°, for a minute. Problem 6: Kepler's ellipse, and the double pendulum.
#include <algorithm>

#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr int kOrbits = 20;
constexpr int kTicksPerOrbit = 500;  // 16,000 evaluations with 8 sub-steps of a method that needs 4 each
constexpr double kEccentricity = 0.6;
constexpr double kGravity = 10;
constexpr int kSwingTicks = 1800;
constexpr int kPendulumTicks = 150;

// A point on a rod of 1 m starts at 90° and swings for 60 s under 10 m/s². The textbook methods solve for its
// angle and cannot stretch the rod; engines have a joint. Correct: energy and length stay.
std::vector<Case> makePendulum() {
  Case swing;
  swing.scene.bodies = {point({1, 0})};
  swing.scene.joints = {rod(-1, {0, 0}, 0, {1, 0})};
  swing.scene.gravity = {0, -kGravity};
  swing.scene.ticks = kSwingTicks;
  Pendulum system;
  system.gravity = kGravity;
  system.angle = M_PI / 2;
  swing.scene.equations = equationsOf(system);
  swing.metrics = {{"energy_drift", "largest |ΔE| / mgL", 1e-4, 1e-15},
                   {"length", "largest relative error of the length", 1e-10, 1e-16}};
  swing.cpu_bounds = {{"cpu_ratio", "box2d", 4, 1.0 / 15}};
  swing.judge = [scene = swing.scene](const Trial& trial) {
    return trial.largest(scene, [](int /*tick*/, const Simulation& simulation) {
      const BodyState state = simulation.body(0);
      // The pendulum starts at rest and horizontally, so its energy is 0. The error is relative to g ×
      // length, the range of its potential energy.
      const double energy = dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y;
      return std::vector<double>{std::abs(energy) / kGravity, std::abs(length(state.position) - 1)};
    });
  };
  return {swing};
}

double keplerMu() {
  const double rate = 2 * M_PI / (kTicksPerOrbit * kTick);
  return rate * rate;
}

// Returns the planet's position after `orbits` orbits, by Kepler's equation.
std::vector<double> keplerPlace(Quad orbits) {
  const Quad mean = 2 * kQuadPi * (orbits - floorq(orbits));
  Quad anomaly = mean;
  Quad change = 1;
  for (int i = 0; i < 100 && abs(change) > Quad(1e-30); ++i) {
    change = (anomaly - kEccentricity * sin(anomaly) - mean) / (1 - kEccentricity * cos(anomaly));
    anomaly -= change;
  }
  const Quad e = kEccentricity;
  return {static_cast<double>(cos(anomaly) - e), static_cast<double>(sqrt(1 - e * e) * sin(anomaly))};
}

Case kepler() {
  Case orbit("kepler", "Kepler's ellipse");
  Kepler system;
  system.mu = keplerMu();
  system.eccentricity = kEccentricity;
  const std::vector<double> start = system.start();
  orbit.scene.bodies = {point({start[0], start[1]}, {start[2], start[3]})};
  orbit.scene.ticks = kOrbits * kTicksPerOrbit;
  orbit.scene.equations = equationsOf(system);
  orbit.scene.field = [mu = system.mu](double, const BodyState& state) {
    const double distance = length(state.position);
    return -mu / (distance * distance * distance) * state.position;
  };
  // All steps have equal lengths in time. The floor of 1e-12 is the unavoidable rounding of 10,000 steps.
  orbit.metrics = {
      {"end_error", "distance from the start after 20 orbits, of the semi-major axis", 1e-5, 1e-12},
      {"energy_drift", "largest |ΔE/E|", 1e-10, 1e-15}};
  Path path;
  for (int tick = 0; tick <= orbit.scene.ticks; ++tick)
    path.push_back(keplerPlace(Quad(tick) / kTicksPerOrbit));
  orbit.judge = [scene = orbit.scene, path, mu = system.mu](const Trial& trial) {
    const double right = -mu / 2;
    double worst = 0;
    const PathErrors errors = compare(trial, scene, path, 1, [&](const Simulation& simulation) {
      const BodyState state = simulation.body(0);
      const double energy = dot(state.velocity, state.velocity) / 2 - mu / length(state.position);
      worst = std::max(worst, std::abs(energy / right - 1));
      return positionOf(simulation, 0);
    });
    return std::vector<double>{errors.end, worst};
  };
  return orbit;
}

Case doublePendulum() {
  Case swing("double_pendulum", "double pendulum");
  swing.scene.bodies = {point({1, 0}), point({2, 0})};
  swing.scene.joints = {rod(-1, {0, 0}, 0, {1, 0}), rod(0, {1, 0}, 1, {2, 0})};
  swing.scene.gravity = {0, -kGravity};
  swing.scene.ticks = kPendulumTicks;
  DoublePendulum system;
  system.gravity = kGravity;
  system.angle = M_PI / 2;
  swing.scene.equations = equationsOf(system);
  swing.metrics = {{"end_error", "distance of the lower point from its true place after 5 s, m", -1, 1e-12},
                   {"energy_drift", "largest |ΔE| / 3mgL", -1, 1e-15}};
  const Path angles = swing.scene.equations->byExtrapolation(kTick, kPendulumTicks, Stiffness::NONE);
  const Vec right = system.body(1, angles.back().data()).position;
  swing.judge = [scene = swing.scene, right](const Trial& trial) {
    double worst = 0;
    const SimulationPtr end = trial.run(scene, [&](int, const Simulation& simulation) {
      double energy = 0;
      for (const int i : {0, 1}) {
        const BodyState state = simulation.body(i);
        energy += dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y;
      }
      worst = std::max(worst, std::abs(energy) / (3 * kGravity));
    });
    return std::vector<double>{length(end->body(1).position - right), worst};
  };
  return swing;
}

// A planet with e = 0.6, 20 orbits of 500 ticks: 8 sub-steps of a method with 4 force evaluations are 16,000
// evaluations an orbit. Two points of 1 kg on rods of 1 m, both horizontal at the start, 5 s (after that the
// motion is chaotic). Correct: Kepler's equation in quad precision; for the double pendulum, extrapolation in
// quad precision, whose result CVODE confirms.
std::vector<Case> makeOrbits() {
  return {kepler(), doublePendulum()};
}

const RegisteredProblem pendulum("5", "pendulum", makePendulum, "Pendulum",
                                 "A lamp on a chain must not come to rest by itself, and must cost little.");
const RegisteredProblem orbits(
    "6", "orbits", makeOrbits, "Kepler's ellipse and the double pendulum",
    "Orbits that close, and a motion that magnifies each error: what a method of high order is for.");

}  // namespace
}  // namespace lab
