// One run of a scene in one engine: the time of each tick, and the errors found.
#pragma once

#include <vector>

#include "Scene.h"
#include "Simulation.h"

namespace bench::physics {

struct Run {
  std::vector<double> tick_ms;   ///< CPU time of each tick
  std::vector<double> overlaps;  ///< deepest overlap in metres at each check, in scenes with collisions
  double joint_error = 0;        ///< largest gap in a hinge at any check, in metres
  int looks = 0;
  int failed = 0;    ///< largest number of frozen, not finite or escaped bodies at any check or at the end
  bool cut = false;  ///< stopped at the time limit

  /// Returns the mean time of the first `ticks` ticks.
  double meanMs(std::size_t ticks) const;
  double worstMs() const;
  /// Returns the mean of `overlaps`, which must not be empty.
  double meanOverlap() const;
};

/// Runs all ticks of the scene, and checks after each tenth. Stops after the tick in which the engine's CPU
/// time exceeds `most_seconds`.
Run run(const Scene& scene, Simulation& simulation, double most_seconds);

}  // namespace bench::physics
