// Converts scenes of the bench suite `physics` to the laboratory's, so that both use equal bodies. In the
// bench's scenes y and gravity point down.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"
#include "physics/Scene.h"

namespace lab {

namespace heaps = bench::physics;

constexpr int kTicksPerLook = 10;
constexpr int kPeerSteps = 4;  ///< steps of Box2D per tick: 1/120 s each

Scene sceneOf(const heaps::Scene& scene);

heaps::Pose poseOf(const BodyState& state);
/// Returns the poses of all bodies of the scene.
std::vector<heaps::Pose> posesOf(const heaps::Scene& scene, const Simulation& simulation);

/// Returns the number of dynamic bodies outside the scene's Room, plus those that the method no longer moves.
long countLost(const heaps::Scene& scene, const Simulation& simulation);

}  // namespace lab
