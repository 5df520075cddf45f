// A scene that a method runs.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "tests/accuracy/scene/Scene.h"

namespace lab {

/// Amount of work in a tick, from which its time limit is computed.
struct Work {
  double contacts = 0;  ///< contacts that were solved, once per tick each
  double impacts = 0;   ///< impacts that were handled at their exact time
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Advances by `tick` seconds in `substeps` equal parts. Only this call is timed.
  virtual void step(double tick, int substeps) = 0;

  /// Returns the state of the body with this index in the scene.
  virtual BodyState body(int index) const = 0;
  /// Returns the generalised coordinates if the method solves the scene's equations; otherwise empty.
  virtual std::span<const double> coordinates() const { return {}; }
  /// Returns how many contacts have begun so far; −1 if not counted.
  virtual long contacts() const { return -1; }
  /// Returns how many bodies the method no longer moves.
  virtual long frozen() const { return 0; }
  /// Returns the work of all ticks so far; nullopt if not counted.
  virtual std::optional<Work> work() const { return {}; }
};

using SimulationPtr = std::unique_ptr<Simulation>;

}  // namespace lab
