// A world that runs a Scene, in this project's engine or in Box2D.
#pragma once

#include <cstddef>
#include <memory>

#include "Scene.h"
#include "physics/body/PhysicsManager.h"

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

/// Builds the scene of df::Body Objects in its own World, in which a metre is a cell in both directions.
/// Static bodies are ordinary HARD Objects. Throws std::runtime_error if the world would differ from the
/// scene.
SimulationPtr makeNaiad(const Scene& scene, df::Accuracy accuracy);
/// Uses Box2D 2.4.1 as built by Debian: four steps of 1/120 s per tick, with the 8 velocity and 3 position
/// iterations that its manual recommends. Boxes have their full sides; Box2D's polygon skin adds to them.
SimulationPtr makeBox2d(const Scene& scene);

}  // namespace bench::physics
