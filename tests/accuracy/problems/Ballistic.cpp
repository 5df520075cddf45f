// 1: a point thrown under gravity.
#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr Vec kThrown{3, 20};
constexpr double kGravity = 10;
constexpr int kTicks = 60;

Problem make() {
  Problem problem;
  problem.title = "Ballistic flight";
  problem.text = "A point is thrown with (3, 20) m/s under 10 m/s² and flies for 2 s.";
  problem.reference = "x₀ + v₀t + ½gt², in quad precision";
  problem.why = "Everything that is thrown flies like this; a fixed-step engine lands early by half a step.";
  Case flight;
  flight.scene.bodies = {point({}, kThrown)};
  flight.scene.gravity = {0, -kGravity};
  flight.scene.ticks = kTicks;
  Flight system;
  system.velocity = kThrown;
  system.gravity = kGravity;
  flight.scene.equations = equationsOf(system);
  flight.metrics =
      pathMetrics(1e-12, 1e-16, "Box2D 0.042 m = 2.0e-3 (1/240 s), Chipmunk 0.167 m = 8.0e-3 (1/60 s)");
  const Path path = pathOf(kTicks, [](Quad t) {
    return std::vector<Quad>{kThrown.x * t, kThrown.y * t - kGravity * t * t / 2};
  });
  flight.judge = alongPath(flight.scene, path, length({path.back()[0], path.back()[1]}),
                           [](const Simulation& s) { return positionOf(s); });
  problem.cases.push_back(flight);
  return problem;
}

const RegisteredProblem problem("1", "ballistic", make);

}  // namespace
}  // namespace lab
