// Problem 3: an undamped spring.
#include "Problem.h"
#include "SpringScene.h"

namespace lab {
namespace {

constexpr double kRest = 10;
constexpr int kPeriods = 10;

Case oscillator(int hertz) {
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
std::vector<Case> make() {
  return {oscillator(1), oscillator(5), oscillator(15)};
}

const RegisteredProblem problem(
    "3", "spring", make, "Undamped spring",
    "What swings must go on swinging, at its own rate: peers either stop it or make it swing higher.");

}  // namespace
}  // namespace lab
