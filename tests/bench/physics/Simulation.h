// A world that runs a Scene: ours, or Box2D's.
#pragma once

#include <cstddef>
#include <memory>

#include "Scene.h"

namespace bench::physics {

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual void tick() = 0;
  /// Of a body, by its index in the scene.
  virtual Pose pose(std::size_t body) const = 0;
  /// Has the engine given up moving it?
  virtual bool isFrozen(std::size_t body) const = 0;
};

using SimulationPtr = std::unique_ptr<Simulation>;

}  // namespace bench::physics
