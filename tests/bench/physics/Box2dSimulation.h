// Box2D 2.4.1, as Debian builds it: four steps of 1/120 s a tick, with the 8 velocity and 3 position
// iterations that its manual recommends. Boxes have their full sides; the skin that Box2D puts around
// polygons comes on top.
#pragma once

#include "Simulation.h"

namespace bench::physics {

SimulationPtr makeBox2d(const Scene& scene);

}  // namespace bench::physics
