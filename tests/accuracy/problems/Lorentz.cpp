// Problem 22: bodies in a magnetic field, free and constrained.
#include <cmath>
#include <string>

#include "Path.h"

namespace lab {
namespace {

constexpr double kSpeed = 3;   // m/s; a tenth of a cell per tick
constexpr double kLength = 5;  // length of the rod, m
constexpr double kRadius = 0.25;
constexpr int kTicks = 100;

// Returns a field that turns velocities by `rate` rad per tick, clockwise if y points up.
Field magnet(double rate) {
  return [rate](double /*t*/, const BodyState& state) {
    const double omega = rate / kTick;
    return Vec{omega * state.velocity.y, -omega * state.velocity.x};
  };
}

// Measures the distance from a path given by a formula, and the change of the speed.
using Formula = Vec (*)(double t, double omega);

Case along(const std::string& name, Scene scene, double rate, Formula path, double far, double drift) {
  Case moved(name, "", std::move(scene));
  moved.scene.field = magnet(rate);
  moved.scene.ticks = kTicks;
  moved.metrics = {{"sup_error_m", "largest distance from the path, m", far, 1e-13},
                   {"energy_drift", "largest change of energy, relative", drift, 1e-15}};
  moved.judge = [scene = moved.scene, rate, path](const Trial& trial) {
    return trial.largest(scene, [&](int tick, const Simulation& simulation) {
      const BodyState state = simulation.body(0);
      const Vec off = state.position - path(tick * scene.tick, rate / scene.tick);
      const double energy = dot(state.velocity, state.velocity) / (kSpeed * kSpeed);
      return std::vector<double>{length(off), std::abs(energy - 1)};
    });
  };
  return moved;
}

Vec onCircle(double t, double omega) {
  return kSpeed / omega * Vec{std::sin(omega * t), std::cos(omega * t) - 1};
}
Vec onFloor(double t, double /*omega*/) {
  return {kSpeed * t, kRadius};
}
Vec aboutPivot(double t, double /*omega*/) {
  const double angle = kSpeed / kLength * t;
  return {kLength * std::sin(angle), kLength * (1 - std::cos(angle))};
}

Case freely(double rate, const std::string& name) {
  Scene scene;
  scene.bodies = {ball({0, 0}, {kSpeed, 0}, kRadius)};
  return along(name, scene, rate, onCircle, 1e-6, 1e-6);
}

// The field presses the ball onto the floor.
Case overFloor(double rate, const std::string& name) {
  Scene scene;
  scene.bodies = {ball({0, kRadius}, {kSpeed, 0}, kRadius), wall({0, -0.5}, {100, 0.5})};
  return along(name, scene, rate, onFloor, 1e-6, 1e-6);
}

Case onRod(double rate, const std::string& name) {
  Scene scene;
  scene.bodies = {ball({0, 0}, {kSpeed, 0}, kRadius)};
  scene.joints = {rod(-1, {0, kLength}, 0, {0, 0})};
  return along(name, scene, rate, aboutPivot, 0.01, 1e-4);
}

// A ball of 3 m/s in a field that turns its velocity by 1 to 10⁴ radians a tick: free, over a floor onto
// which the field presses it, and on a rod of 5 m; 100 ticks, no gravity, no friction. Correct: a circle of
// v/ω, the floor's line, the rod's circle at constant speed: the force does no work.
std::vector<Case> make() {
  std::vector<Case> cases;
  for (const double rate : {1.0, 10.0, 1e3, 1e4}) {
    cases.push_back(freely(rate, "free" + std::to_string(static_cast<int>(rate))));
  }
  for (const double rate : {1.0, 1e3}) {
    cases.push_back(overFloor(rate, "floor" + std::to_string(static_cast<int>(rate))));
    cases.push_back(onRod(rate, "rod" + std::to_string(static_cast<int>(rate))));
  }
  return cases;
}

const RegisteredProblem problem("22", "lorentz", make, "In a magnet",
                                "A force that turns a motion must not brake it or make it faster.");

}  // namespace
}  // namespace lab
