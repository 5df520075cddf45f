// Problem 3: an undamped spring. Problem 4: a stiff damped spring with gravity, and a stability map.
#include <limits>

#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr double kRest = 10;  // rest length, m

// Makes a scene of a mass on a spring with the anchor at 0. The mass starts `system.offset` beyond the rest
// length.
Scene springScene(const SpringLine& system, int ticks) {
  Scene scene;
  const Vec position = (system.rest_length + system.offset) * system.direction;
  scene.bodies = {point(position)};
  scene.joints = {spring(-1, {}, 0, position, system.stiffness)};
  scene.joints[0].damping = system.damping;
  scene.joints[0].rest_length = system.rest_length;
  scene.gravity = system.gravity * system.direction;
  scene.ticks = ticks;
  scene.equations = equationsOf(system);
  return scene;
}

// Returns the offset of the mass from the rest length at time t, by the closed form.
Quad springOffset(const SpringLine& system, Quad t) {
  const Quad rest = Quad(system.gravity) / system.stiffness;
  const Quad start = system.offset - rest;
  const Quad decay = Quad(system.damping) / 2;
  const Quad square = Quad(system.stiffness) - decay * decay;
  Quad part = 0;
  if (square > 0) {
    const Quad omega = sqrt(square);
    part = exp(-decay * t) * (cos(omega * t) + decay / omega * sin(omega * t));
  } else if (square == 0) {
    part = exp(-decay * t) * (1 + decay * t);
  } else {
    const Quad root = sqrt(-square);
    const Quad slow = system.stiffness / (decay + root);  // decay − root without cancellation
    const Quad fast = decay + root;
    part = (fast * exp(-slow * t) - slow * exp(-fast * t)) / (2 * root);
  }
  return rest + start * part;
}

Case oscillator(int hertz) {
  constexpr int kPeriods = 10;
  Case spring(std::to_string(hertz) + "hz", std::to_string(hertz) + " Hz");
  SpringLine system;
  const double omega = 2 * M_PI * hertz;
  system.stiffness = omega * omega;
  system.rest_length = kRest;
  spring.scene = springScene(system, 30 * kPeriods / hertz);
  spring.metrics = {{"amplitude", "|amplitude left − 1| after 10 periods", 1e-12, 1e-15},
                    {"phase_rad", "phase error after 10 periods, rad", 1e-12, 1e-14}};
  spring.judge = [scene = spring.scene, omega](const Trial& trial) {
    const SimulationPtr end = trial.run(scene);
    const auto coordinates = end->coordinates();
    const BodyState state = end->body(0);
    const double x = coordinates.empty() ? state.position.x - kRest : coordinates[0];
    const double v = state.velocity.x / omega;
    return std::vector<double>{std::abs(std::hypot(x, v) - 1), std::abs(std::atan2(-v, x))};
  };
  return spring;
}

// 1 kg swings on a spring of rest length 10 m with an amplitude of 1 m, 10 periods. Correct: A cos ωt, in
// quad precision.
std::vector<Case> makeUndamped() {
  return {oscillator(1), oscillator(5), oscillator(15)};
}

constexpr int kTicks = 300;  // 10 s
constexpr double kGravity = 10;

SpringLine springOf(double stiffness, double zeta) {
  SpringLine system;
  system.stiffness = stiffness;
  system.damping = 2 * zeta * std::sqrt(stiffness);
  system.gravity = kGravity;
  system.offset = kGravity / stiffness + 1;
  system.direction = {0, -1};
  system.rest_length = kRest;
  return system;
}

// Returns the distance of the mass from its rest position. Uses the method's coordinates if it has any,
// otherwise the body's position.
std::vector<double> offsetOf(const Simulation& simulation) {
  const auto coordinates = simulation.coordinates();
  return {coordinates.empty() ? -simulation.body(0).position.y - kRest : coordinates[0]};
}

Case caseOf(double stiffness, double zeta) {
  Case spring;
  const SpringLine system = springOf(stiffness, zeta);
  spring.scene = springScene(system, kTicks);
  const Path path = pathOf(kTicks, [&](Quad t) { return std::vector<Quad>{springOffset(system, t)}; });
  spring.judge = [scene = spring.scene, path](const Trial& trial) {
    return std::vector<double>{compare(trial, scene, path, 1, offsetOf).sup};
  };
  return spring;
}

// A mass of 1 kg hangs on a spring of k N/m with damping ratio ζ and starts 1 m below its equilibrium; 10 s.
// In one tick, the phase of the undamped oscillation advances by 0.33 rad (k = 1e2), 33 rad (1e6) or 3333 rad
// (1e10). Correct: the exponential of the 2×2 matrix of the motion, in quad precision.
std::vector<Case> makeDiagram() {
  std::vector<Case> cases;
  for (const double stiffness : {1e2, 1e6, 1e10}) {
    for (const double zeta : {0.0, 0.05, 1.0, 2.0}) {
      Case spring = caseOf(stiffness, zeta);
      const std::string ratio = zeta == 0.05 ? "0.05" : std::to_string(std::lround(zeta));
      spring.name = "k" + power(stiffness) + "_zeta" + ratio;
      spring.label = "stiffness " + power(stiffness) + ", damping ratio " + ratio;
      const double rounding =
          4 * std::numeric_limits<double>::epsilon() * std::sqrt(stiffness) * spring.scene.duration();
      spring.metrics = {{"sup_error", "largest error over the run, m", 1e-11 + rounding, rounding / 4}};
      cases.push_back(spring);
    }
  }
  return cases;
}

Case slightlyDamped(double stiffness) {
  Case spring = caseOf(stiffness, 0.05);
  spring.name = "k" + power(stiffness);
  spring.label = "stiffness " + power(stiffness);
  return spring;
}

// The spring of problem 4 with ζ = 0.05. A cell is the largest error over 10 s, of 1 m at the start. Correct:
// as in problem 4.
std::vector<Case> makeMap() {
  return mapOf(1e10, slightlyDamped, {"sup_error", "stiffness, N/m", -1, 0});
}

const RegisteredProblem undamped(
    "3", "spring", makeUndamped, "Undamped spring",
    "What swings must go on swinging, at its own rate: peers either stop it or make it swing higher.");
const RegisteredProblem diagram(
    "4", "stiff-spring", makeDiagram, "Stiff damped spring with gravity",
    "An author who wants it stiffer writes a larger number. No number may make it explode.");
const RegisteredProblem map("map-stiffness", "stiffness-map", makeMap, "What stays bounded: stiffness × step",
                            "", Problem::Kind::MAP);

}  // namespace
}  // namespace lab
