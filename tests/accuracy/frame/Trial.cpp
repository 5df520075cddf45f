#include "Trial.h"

#include <cmath>

namespace lab {
namespace {

constexpr double kFarthest = 1e12;
constexpr double kLargest = 1e30;

bool isBelow(double value, double bound) {
  return std::abs(value) < bound;  // false for NaN
}

}  // namespace

ScenePace paceOf(const Method& method, const Scene& scene, int substeps) {
  ScenePace pace{scene, 1};
  if (method.own_substeps == 0 || substeps == method.own_substeps) return pace;
  pace.each = substeps / method.own_substeps;
  pace.scene.tick /= pace.each;
  pace.scene.ticks *= pace.each;
  return pace;
}

SimulationPtr Trial::build(const Scene& scene) const {
  SimulationPtr simulation = m_method.build(scene);
  if (simulation == nullptr) throw Inexpressible();
  return simulation;
}

void Trial::step(Simulation& simulation, const Scene& scene) const {
  simulation.step(scene.tick, m_substeps);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const BodyState state = simulation.body(i);
    if (!isBelow(state.position.x, kFarthest) || !isBelow(state.position.y, kFarthest))
      throw Failure("blew up");
  }
  for (const double value : simulation.coordinates()) {
    if (!isBelow(value, kLargest)) throw Failure("blew up");
  }
}

}  // namespace lab
