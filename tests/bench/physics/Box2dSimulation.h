// Box2D 2.4.1 as built by Debian: four steps of 1/120 s per tick, with the 8 velocity and 3 position
// iterations that its manual recommends. Boxes have their full sides; Box2D's polygon skin adds to them.
#pragma once

#include "Simulation.h"

namespace bench::physics {

SimulationPtr makeBox2d(const Scene& scene);

}  // namespace bench::physics
