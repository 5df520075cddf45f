// Problem 5: a pendulum released at 90°, for a minute.
#include <algorithm>

#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr int kTicks = 1800;
constexpr double kGravity = 10;
constexpr double kStart = M_PI / 2;

// Returns the complete elliptic integral of the first kind by the arithmetic-geometric mean.
Quad ellipticK(Quad k) {
  Quad a = 1;
  Quad b = sqrt(1 - k * k);
  while (abs(a - b) > Quad(1e-30) * a) {
    const Quad mean = (a + b) / 2;
    b = sqrt(a * b);
    a = mean;
  }
  return kQuadPi / (2 * a);
}

Quad periodOf(double angle) {
  return 4 * sqrt(1 / Quad(kGravity)) * ellipticK(sin(Quad(angle) / 2));
}

struct Swing {
  double angle = 0;
  double rate = 0;
};

Swing swingOf(const BodyState& state) {
  const double square = dot(state.position, state.position);
  return {std::atan2(state.position.x, -state.position.y), cross(state.position, state.velocity) / square};
}

// Returns when the angle passes 0 between two ticks, in ticks. Uses the quintic polynomial through the
// angles, rates and accelerations at both; the accelerations follow from the angles.
double crossing(const Swing& a, const Swing& b, double h) {
  const double da = a.rate * h;
  const double db = b.rate * h;
  const double ca = -kGravity * std::sin(a.angle) * h * h;
  const double cb = -kGravity * std::sin(b.angle) * h * h;
  const double rise = b.angle - a.angle - da - ca / 2;
  const double slope = db - da - ca;
  const double bend = cb - ca;
  const double c3 = 10 * rise - 4 * slope + bend / 2;
  const double c4 = -15 * rise + 7 * slope - bend;
  const double c5 = 6 * rise - 3 * slope + bend / 2;
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double s = (low + high) / 2;
    const double value = a.angle + s * (da + s * (ca / 2 + s * (c3 + s * (c4 + s * c5))));
    ((value < 0) == (a.angle < 0) ? low : high) = s;
  }
  return (low + high) / 2;
}

// Returns the errors of period, energy and length of a run.
std::vector<double> judgePendulum(const Trial& trial, const Scene& scene) {
  double first = -1;
  double last = -1;
  int crossings = 0;
  double worst_energy = 0;
  double worst_length = 0;
  Swing before{kStart, 0};
  trial.run(scene, [&](int tick, const Simulation& simulation) {
    const BodyState state = simulation.body(0);
    const Swing now = swingOf(state);
    if ((before.angle < 0) != (now.angle < 0) && std::abs(now.angle) < 2) {
      last = (tick - 1 + crossing(before, now, scene.tick)) * scene.tick;
      if (crossings == 0) first = last;
      ++crossings;
    }
    before = now;
    // The pendulum starts at rest and horizontally, so its energy is 0. The error is relative to g × length,
    // the range of its potential energy.
    const double energy = dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y;
    worst_energy = std::max(worst_energy, std::abs(energy) / kGravity);
    worst_length = std::max(worst_length, std::abs(length(state.position) - 1));
  });
  if (crossings < 2) throw Failure("does not swing");
  const double period = 2 * (last - first) / (crossings - 1);
  const auto right = static_cast<double>(periodOf(kStart));
  return {std::abs(period / right - 1), worst_energy, worst_length};
}

// A point on a rod of 1 m starts at 90° and swings for 60 s under 10 m/s². The textbook methods solve for its
// angle and cannot stretch the rod; engines have a joint. The period is the mean over the run, zeros found by
// quintic interpolation between ticks. Correct: 4√(L/g) K(sin θ₀/2) by the arithmetic-geometric mean in quad
// precision; energy and length stay.
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
  swing.metrics = {{"period", "relative error of the period", -1, 1e-11},
                   {"energy_drift", "largest |ΔE| / mgL", 1e-4, 1e-15},
                   {"length", "largest relative error of the length", 1e-10, 1e-16}};
  swing.cpu_bounds = {{"cpu_ratio", "box2d", 4, 1.0 / 15}};
  swing.judge = [scene = swing.scene](const Trial& trial) { return judgePendulum(trial, scene); };
  return {swing};
}

const RegisteredProblem problem("5", "pendulum", make, "Pendulum",
                                "A lamp on a chain must not come to rest by itself, and must cost little.");

}  // namespace
}  // namespace lab
