// Converts scenes of the bench suite `physics` to the laboratory's, so that both use equal bodies. In the
// bench's scenes y and gravity point down.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"
#include "physics/Scene.h"

namespace lab {

Scene sceneOf(const bench::physics::Scene& scene);

bench::physics::Pose poseOf(const BodyState& state);
/// Returns the poses of all bodies of the scene.
std::vector<bench::physics::Pose> posesOf(const bench::physics::Scene& scene, const Simulation& simulation);

/// Returns the number of dynamic bodies outside the scene's Room, plus those that the method no longer moves.
long countLost(const bench::physics::Scene& scene, const Simulation& simulation);

}  // namespace lab
