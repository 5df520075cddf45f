// How deep bodies lie in each other: the judge of both engines. It shares no code with them.
#pragma once

#include <vector>

#include "Scene.h"

namespace bench::physics {

/// The deepest overlap of two parts of different bodies, of which at least one is dynamic, in metres: by how
/// much the two would have to be moved apart. 0 if none overlap. `poses` has one pose per body.
double deepestOverlap(const std::vector<Body>& bodies, const std::vector<Pose>& poses);

/// The largest distance of the two points that a hinge holds together, in metres; 0 without hinges.
double widestHinge(const Scene& scene, const std::vector<Pose>& poses);

}  // namespace bench::physics
