// Measures how deep bodies overlap, for all engines. It shares no code with them.
#pragma once

#include <vector>

#include "tests/accuracy/frame/Simulation.h"

namespace lab {

/// Returns the states of all bodies of the scene.
std::vector<BodyState> statesOf(const Scene& scene, const Simulation& simulation);

/// Returns the deepest overlap of two shapes of different bodies, at least one of them dynamic, in metres:
/// the distance that would separate them. 0 if none overlap. `states` has one state per body.
double deepestOverlap(const std::vector<Body>& bodies, const std::vector<BodyState>& states);

/// Returns the largest gap between the two points of a hinge, in metres; 0 without joints.
double widestHinge(const Scene& scene, const std::vector<BodyState>& states);

/// Returns the largest stretch of a rod, relative to its length.
double widestStretch(const Scene& scene, const std::vector<BodyState>& states);

/// Returns the number of dynamic bodies whose positions are not finite or outside the scene's Room, plus the
/// number of bodies that the engine has frozen.
long countLost(const Scene& scene, const Simulation& simulation);

}  // namespace lab
