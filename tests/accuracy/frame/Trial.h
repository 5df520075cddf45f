// One method at one number of sub-steps, as a problem's judge uses it.
#pragma once

#include <stdexcept>
#include <string>

#include "Method.h"

namespace lab {

/// The run cannot be used: it blew up, collapsed or crashed. It is a result, and is drawn as one.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The method has no way to express the scene: there is no result.
struct Inexpressible : std::runtime_error {
  Inexpressible() : std::runtime_error("the method cannot express the scene") {}
};

/// A scene as a method runs it. A method that chooses its sub-steps itself is asked for more by shorter
/// ticks, as a world that runs faster has them: `each` of them are one of the scene's.
struct ScenePace {
  Scene scene;
  int each = 1;
};
ScenePace paceOf(const Method& method, const Scene& scene, int substeps);

class Trial {
 public:
  Trial(const Method& method, int substeps) : m_method(method), m_substeps(substeps) {}

  /// Throws Inexpressible.
  SimulationPtr build(const Scene& scene) const;

  /// Advances by one tick. Throws Failure if a body is then at no place that is a number below 1e12 m (or
  /// coordinates below 1e30).
  void step(Simulation& simulation, const Scene& scene) const;

  /// Runs the whole scene and calls `after(tick, simulation)` with tick = 1, 2, … after each. Returns the
  /// simulation as it ends.
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

  const Method& method() const { return m_method; }
  int substeps() const { return m_substeps; }

 private:
  const Method& m_method;
  int m_substeps;
};

}  // namespace lab
