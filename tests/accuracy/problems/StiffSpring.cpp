// Problem 4: a stiff damped spring with gravity, and a stability map.
#include <limits>

#include "Path.h"
#include "SpringScene.h"

namespace lab {
namespace {

constexpr int kTicks = 300;  // 10 s
constexpr double kGravity = 10;
constexpr double kRest = 10;

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

// Returns the distance of the mass from the rest length: from the coordinates if the method has them, else
// from the body.
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
      spring.name =
          "k" + power(stiffness) + "_zeta" + (zeta == 0.05 ? "0.05" : std::to_string(std::lround(zeta)));
      spring.label = "stiffness " + power(stiffness) + ", damping ratio " +
                     (zeta == 0.05 ? "0.05" : std::to_string(std::lround(zeta)));
      const double rounding =
          4 * std::numeric_limits<double>::epsilon() * std::sqrt(stiffness) * spring.scene.duration();
      spring.metrics = {{"sup_error", "largest error over the run, m", 1e-11 + rounding, rounding / 4}};
      cases.push_back(spring);
    }
  }
  return cases;
}

// The spring of problem 4 with ζ = 0.05. A cell is the largest error over 10 s, of 1 m at the start. Right
// is: as in problem 4.
std::vector<Case> makeMap() {
  std::vector<Case> cases;
  for (double stiffness = 1; stiffness < 2e10; stiffness *= 10) {
    Case spring = caseOf(stiffness, 0.05);
    spring.name = "k" + power(stiffness);
    spring.label = "stiffness " + power(stiffness);
    spring.x = stiffness;
    spring.metrics = {{"sup_error", "stiffness, N/m", -1, 0}};
    cases.push_back(spring);
  }
  return cases;
}

const RegisteredProblem diagram(
    "4", "stiff-spring", makeDiagram, "Stiff damped spring with gravity",
    "An author who wants it stiffer writes a larger number. No number may make it explode.");
const RegisteredProblem map("map-stiffness", "stiffness-map", makeMap, "What stays bounded: stiffness × step",
                            "", Problem::Kind::MAP);

}  // namespace
}  // namespace lab
