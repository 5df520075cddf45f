// 1: a point thrown under gravity.
#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr Vec kThrown{3, 20};
constexpr double kGravity = 10;
constexpr int kTicks = 60;

// A point is thrown with (3, 20) m/s under 10 m/s² and flies for 2 s. Correct: x₀ + v₀t + ½gt², in quad
// precision.
std::vector<Case> make() {
  Case flight;
  flight.scene.bodies = {point({}, kThrown)};
  flight.scene.gravity = {0, -kGravity};
  flight.scene.ticks = kTicks;
  Flight system;
  system.velocity = kThrown;
  system.gravity = kGravity;
  flight.scene.equations = equationsOf(system);
  flight.metrics = pathMetrics(1e-12, 1e-16);
  const Path path = pathOf(kTicks, [](Quad t) {
    return std::vector<Quad>{kThrown.x * t, kThrown.y * t - kGravity * t * t / 2};
  });
  flight.judge = alongPath(flight.scene, path, length({path.back()[0], path.back()[1]}),
                           [](const Simulation& s) { return positionOf(s); });
  return {flight};
}

const RegisteredProblem problem(
    "1", "ballistic", make, "Ballistic flight",
    "Everything that is thrown flies like this; a fixed-step engine lands early by half a step.");

}  // namespace
}  // namespace lab
