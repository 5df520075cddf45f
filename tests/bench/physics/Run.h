// One run of a scene in one engine: the time of each tick, and the errors found.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"

namespace bench::physics {

struct Run {
  std::vector<double> tick_ms;   ///< CPU time of each tick
  std::vector<double> overlaps;  ///< deepest overlap in metres at each check, in scenes with collisions
  double joint_error = 0;        ///< largest error of a hinge in metres, over all checks
  int looks = 0;
  int failed = 0;    ///< maximum number of frozen, not finite or escaped bodies, at the checks and the end
  bool cut = false;  ///< stopped at the time limit

  /// Returns the mean of the first `ticks` ticks.
  double meanMs(std::size_t ticks) const;
  double worstMs() const;
  /// Returns the mean of all checks. There must be at least one.
  double meanOverlap() const;
};

/// Runs all ticks of the scene, and checks after each tenth. Stops after the tick in which the engine's CPU
/// time exceeds `most_seconds`.
Run run(const Scene& scene, Simulation& simulation, double most_seconds);

}  // namespace bench::physics
