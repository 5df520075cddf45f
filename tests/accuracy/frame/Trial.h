// One method at one number of sub-steps. A problem's judge uses it to run scenes.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "Method.h"

namespace lab {

/// The run is unusable: it blew up, collapsed or crashed. This is a result and is drawn as one.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The method cannot express the scene, so there is no result.
struct Inexpressible : std::runtime_error {
  Inexpressible() : std::runtime_error("the method cannot express the scene") {}
};

/// A scene with the ticks that a method gets. A method that chooses its sub-steps itself gets shorter ticks
/// instead of more sub-steps: `each` of them make one tick of the original scene.
struct ScenePace {
  Scene scene;
  int each = 1;
};
ScenePace paceOf(const Method& method, const Scene& scene, int substeps);

class Trial {
 public:
  Trial(const Method& method, int substeps) : m_method(method), m_substeps(substeps) {}

  /// Builds the scene. Throws Inexpressible if the method cannot express it.
  SimulationPtr build(const Scene& scene) const;

  /// Advances by one tick. Throws Failure if a position is then not below 1e12 m, or a coordinate not below
  /// 1e30.
  void step(Simulation& simulation, const Scene& scene) const;

  /// Runs the whole scene and calls `after(tick, simulation)` after each tick, with tick = 1, 2, … Returns
  /// the final simulation.
  template <class After>
  SimulationPtr run(const Scene& scene, After after) const {
    const ScenePace pace = paceOf(m_method, scene, m_substeps);
    SimulationPtr simulation = build(pace.scene);
    for (int tick = 1; tick <= scene.ticks; ++tick) {
      for (int i = 0; i < pace.each; ++i) step(*simulation, pace.scene);
      after(tick, *simulation);
    }
    return simulation;
  }
  SimulationPtr run(const Scene& scene) const {
    return run(scene, [](int, const Simulation&) {});
  }

  /// Runs the whole scene, with read(tick, simulation) after each tick. Returns the maximum of each of its
  /// values, or 0 if all are negative.
  template <class Read>
  std::vector<double> largest(const Scene& scene, Read read) const {
    std::vector<double> most;
    run(scene, [&](int tick, const Simulation& simulation) {
      const std::vector<double> values = read(tick, simulation);
      most.resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) most[i] = std::max(most[i], values[i]);
    });
    return most;
  }

  const Method& method() const { return m_method; }
  int substeps() const { return m_substeps; }

 private:
  const Method& m_method;
  int m_substeps;
};

}  // namespace lab
