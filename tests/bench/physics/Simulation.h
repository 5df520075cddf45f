// A world that runs a Scene, in this project's engine or in Box2D.
#pragma once

#include <cstddef>
#include <memory>

#include "Scene.h"

namespace bench::physics {

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual void tick() = 0;
  /// Returns the pose of the body with this index in the scene.
  virtual Pose pose(std::size_t body) const = 0;
  /// True if the engine no longer moves this body.
  virtual bool isFrozen(std::size_t body) const = 0;
};

using SimulationPtr = std::unique_ptr<Simulation>;

}  // namespace bench::physics
