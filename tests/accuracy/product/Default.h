// The product as a game has it, by what a scene consists of. Each returns null for other scenes.
#pragma once

#include "Scene.h"
#include "Simulation.h"
#include "physics/body/PhysicsManager.h"

namespace lab {

/// Bodies and joints: df::Body Objects in a World, and WM.update().
SimulationPtr bodiesAt(df::Accuracy accuracy, const Scene& scene);
/// The book's Objects, in a World without a layer.
SimulationPtr objectsByDefault(const Scene& scene);
/// A cloth: a df::Cloth in a World, and WM.update().
SimulationPtr clothByDefault(const Scene& scene);
/// An elastic beam: a df::Beam in a World, and WM.update().
SimulationPtr beamByDefault(const Scene& scene);
/// Equations of a dimension that no body has: the call that moves a body through a field.
SimulationPtr equationsByDefault(const Scene& scene);

}  // namespace lab
