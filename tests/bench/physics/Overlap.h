// Measures how deep bodies overlap, for both engines. It shares no code with them.
#pragma once

#include <vector>

#include "Scene.h"

namespace bench::physics {

/// Returns the deepest overlap of two parts of different bodies, at least one of them dynamic, in metres: the
/// distance that would separate them. 0 if none overlap. `poses` has one pose per body.
double deepestOverlap(const std::vector<Body>& bodies, const std::vector<Pose>& poses);

/// Returns the largest gap between the two points of a hinge, in metres; 0 without hinges.
double widestHinge(const Scene& scene, const std::vector<Pose>& poses);

}  // namespace bench::physics
