// Builds a scene of df::Body Objects in its own World, in which a metre is a cell in both directions. Static
// bodies are ordinary HARD Objects.
#pragma once

#include "Simulation.h"
#include "physics/body/PhysicsManager.h"

namespace bench::physics {

/// Throws std::runtime_error if the world would differ from the scene.
SimulationPtr makeNaiad(const Scene& scene, df::Accuracy accuracy);

}  // namespace bench::physics
