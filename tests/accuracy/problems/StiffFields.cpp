// Problem 4b: stiff force fields, and two stiff systems of equations from chemistry and biology.
#include <algorithm>

#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

// Compares the whole path, scaled by each coordinate's maximum.
template <class System>
Case caseOf(const std::string& name, const System& system, const Scene& scene, int ticks, double tick,
            const Path& path) {
  Case field(name, "", scene);
  field.scene.tick = tick;
  field.scene.ticks = ticks;
  field.scene.equations = equationsOf(system);
  field.metrics = pathMetrics(1e-4, 1e-12);
  const std::size_t size = System::kSecondOrder ? path[0].size() / 2 : path[0].size();
  std::vector<double> scale(size, 0);
  for (const auto& state : path) {
    for (std::size_t i = 0; i < size; ++i) scale[i] = std::max(scale[i], std::abs(state[i]));
  }
  Path scaled;
  for (const auto& state : path) {
    std::vector<double> values(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = state[i] / scale[i];
    scaled.push_back(values);
  }
  field.judge = [scene = field.scene, scaled, scale](const Trial& trial) {
    return inOrder(compare(trial, scene, scaled, 1, [&](const Simulation& simulation) {
      std::vector<double> values = scene.abstract() ? coordinatesOf(simulation) : positionOf(simulation, 0);
      values.resize(scale.size());
      for (std::size_t i = 0; i < scale.size(); ++i) values[i] /= scale[i];
      return values;
    }));
  };
  return field;
}

// Makes a scene of one body in a field, which peers can also express.
template <class System>
Scene fieldScene(const System& system, Field acceleration) {
  Scene scene;
  const std::vector<double> start = system.start();
  const BodyState state = system.body(0, start.data());
  scene.bodies = {point(state.position, state.velocity)};
  scene.field = std::move(acceleration);
  return scene;
}

Case vanDerPol() {
  const VanDerPol system;
  constexpr int kTicks = 60;
  const Path path = equationsOf(system)->byExtrapolation(kTick, kTicks, Stiffness::STIFF);
  const Scene scene = fieldScene(system, [system](double, const BodyState& s) {
    const double x = s.position.x;
    return Vec{((1 - x * x) * s.velocity.x - x) / system.epsilon, 0};
  });
  return caseOf("van_der_pol", system, scene, kTicks, kTick, path);
}

Case stiffPendulum() {
  const StiffPendulum system;
  constexpr int kTicks = 60;
  const Path path = equationsOf(system)->byExtrapolation(kTick, kTicks, Stiffness::NONE);
  const Scene scene = fieldScene(system, [system](double, const BodyState& s) {
    const double distance = length(s.position);
    return -system.stiffness * (distance - 1) / distance * s.position - Vec{0, system.gravity};
  });
  return caseOf("stiff_pendulum", system, scene, kTicks, kTick, path);
}

// Returns the path of a charge that drifts across the fields and gyrates far faster than the tick.
Path chargePath(const Charge& charge, int ticks) {
  const Quad omega = charge.frequency;
  const Quad drift = -Quad(charge.push) / omega;  // velocity of the drift, along y
  const Quad u = charge.velocity.x;
  const Quad w = charge.velocity.y - drift;
  return pathOf(ticks, [&](Quad t) {
    const Quad c = cos(omega * t);
    const Quad s = sin(omega * t);
    return std::vector<Quad>{(u * s + w * (1 - c)) / omega, drift * t + (w * s - u * (1 - c)) / omega, 0, 0};
  });
}

Case charge() {
  const Charge system;
  constexpr int kTicks = 300;
  const Scene scene = fieldScene(system, [system](double, const BodyState& s) {
    return Vec{system.push + system.frequency * s.velocity.y, -system.frequency * s.velocity.x};
  });
  return caseOf("charge", system, scene, kTicks, kTick, chargePath(system, kTicks));
}

Case robertson() {
  constexpr int kTicks = 40;
  constexpr double kSecond = 1;
  const Path path = equationsOf(Robertson())->byExtrapolation(kSecond, kTicks, Stiffness::STIFF);
  return caseOf("robertson", Robertson(), Scene(), kTicks, kSecond, path);
}

Case hires() {
  constexpr int kTicks = 320;
  constexpr double kEnd = 321.8122;
  const Path path = equationsOf(Hires())->byExtrapolation(kEnd / kTicks, kTicks, Stiffness::STIFF);
  return caseOf("hires", Hires(), Scene(), kTicks, kEnd / kTicks, path);
}

// Van der Pol with ε = 1e-6 for 2 s; a pendulum whose rod is a spring of 1e6 N/m, 2 s from the horizontal; a
// charge that gyrates with 100 rad/s while it drifts, 10 s; Robertson's reaction, 40 s in ticks of 1 s;
// HIRES, 321.8122 s in 320 ticks. Errors are relative to the largest value of each coordinate over the run.
// Correct: extrapolation in quad precision at 1e-17, agreeing with CVODE at 1e-12 to 1e-9; the charge:
// closed form.
std::vector<Case> make() {
  return {vanDerPol(), stiffPendulum(), charge(), robertson(), hires()};
}

const RegisteredProblem problem(
    "4b", "stiff-fields", make, "Stiff force fields",
    "A game's own force may be as stiff as it likes, and the engine knows nothing about it but its values.");

}  // namespace
}  // namespace lab
