// A scene as some method runs it.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "Scene.h"

namespace lab {

/// What the cost of a tick is held against.
struct Work {
  double contacts = 0;  ///< that were solved for, once per tick each
  double impacts = 0;   ///< that were handled at their moment
};

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
  /// How many bodies it has given up moving.
  virtual long frozen() const { return 0; }
  /// What all ticks so far had to do; empty: not counted.
  virtual std::optional<Work> work() const { return {}; }
  /// How often an iteration inside the method did not converge.
  virtual long failures() const { return 0; }
};

using SimulationPtr = std::unique_ptr<Simulation>;

}  // namespace lab
