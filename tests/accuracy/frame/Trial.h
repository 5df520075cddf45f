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
    SimulationPtr simulation = build(scene);
    for (int tick = 1; tick <= scene.ticks; ++tick) {
      step(*simulation, scene);
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
