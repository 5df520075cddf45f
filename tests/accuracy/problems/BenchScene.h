// The scenes of the bench `physics` as the laboratory's own, so that both speak of the same bodies. Their y
// points down, and gravity with it.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"
#include "physics/Scene.h"

namespace lab {

Scene sceneOf(const bench::physics::Scene& scene);

bench::physics::Pose poseOf(const BodyState& state);
/// Where the bodies of the scene are.
std::vector<bench::physics::Pose> posesOf(const bench::physics::Scene& scene, const Simulation& simulation);

/// Dynamic bodies that are outside the scene's room, and those that the method has given up.
long countLost(const bench::physics::Scene& scene, const Simulation& simulation);

}  // namespace lab
