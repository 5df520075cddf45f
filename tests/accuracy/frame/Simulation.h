// A scene as some method runs it.
#pragma once

#include <memory>
#include <span>

#include "Scene.h"

namespace lab {

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Advances by `tick` seconds, in `substeps` equal parts. What is timed is this call and nothing else.
  virtual void step(double tick, int substeps) = 0;

  /// Where the body with this index of the scene is now.
  virtual BodyState body(int index) const = 0;
  /// The generalised coordinates, where the method solves the scene's equations; otherwise empty.
  virtual std::span<const double> coordinates() const { return {}; }
  /// How many contacts have begun so far; −1: not counted.
  virtual long contacts() const { return -1; }
  /// How often an iteration inside the method did not converge.
  virtual long failures() const { return 0; }
};

using SimulationPtr = std::unique_ptr<Simulation>;

}  // namespace lab
