// Builds scenes in the product like a game does. There is a function for each kind of scene; it returns null
// for scenes of another kind.
#pragma once

#include "physics/body/PhysicsManager.h"
#include "tests/accuracy/frame/Simulation.h"

namespace lab {

/// Uses df::Body Objects in a World, and WM.update(), for bodies and joints.
SimulationPtr bodiesAt(df::Accuracy accuracy, const Scene& scene);
/// Uses a df::Cloth in a World, and WM.update().
SimulationPtr clothByDefault(const Scene& scene);
/// Uses a df::Beam in a World, and WM.update(), for an elastic beam.
SimulationPtr beamByDefault(const Scene& scene);
/// Uses the call that moves a body through a field, for equations of a dimension that bodies do not have.
SimulationPtr equationsByDefault(const Scene& scene);

}  // namespace lab
