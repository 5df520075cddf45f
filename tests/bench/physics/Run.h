// One run of a scene in one engine: how long each tick took, and what the judge saw.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"

namespace bench::physics {

struct Run {
  std::vector<double> tick_ms;   ///< CPU time of each tick that was run
  std::vector<double> overlaps;  ///< deepest one in metres, at each look at a scene in which bodies collide
  double joint_error = 0;        ///< widest hinge in metres, of all looks
  int looks = 0;
  int failed = 0;    ///< most bodies that were frozen, not finite, or outside the room, at a look or the end
  bool cut = false;  ///< it took longer than it may

  /// Of the first `ticks` ticks.
  double meanMs(std::size_t ticks) const;
  double worstMs() const;
  /// Of all looks; there must be one.
  double meanOverlap() const;
};

/// Runs all ticks of the scene, and looks after each tenth. Stops after the tick in which the engine's CPU
/// time exceeds `most_seconds`.
Run run(const Scene& scene, Simulation& simulation, double most_seconds);

}  // namespace bench::physics
