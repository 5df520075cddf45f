// df::Body Objects in a World of their own; a metre is a cell both ways. What never moves is an ordinary HARD
// Object.
#pragma once

#include "Simulation.h"
#include "physics/body/PhysicsManager.h"

namespace bench::physics {

/// Throws std::runtime_error if the world would be another than the scene says.
SimulationPtr makeNaiad(const Scene& scene, df::Accuracy accuracy);

}  // namespace bench::physics
