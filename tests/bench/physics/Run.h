// One run of a scene in one engine: the time of each tick, and the errors found.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "../ElapsedTime.h"
#include "Overlap.h"
#include "Scenes.h"

namespace bench::physics {

struct Run {
  std::vector<double> tick_ms;   ///< CPU time of each tick
  std::vector<double> overlaps;  ///< deepest overlap in metres at each check, in scenes with collisions
  double joint_error = 0;        ///< largest gap in a hinge at any check, in metres
  int looks = 0;
  long failed = 0;   ///< largest number of frozen, not finite or escaped bodies at any check or at the end
  bool cut = false;  ///< stopped at the time limit

  /// Returns the mean time of the first `ticks` ticks.
  double meanMs(std::size_t ticks) const {
    return meanOf({tick_ms.begin(), tick_ms.begin() + static_cast<std::ptrdiff_t>(ticks)});
  }
  double worstMs() const { return *std::max_element(tick_ms.begin(), tick_ms.end()); }
  /// Returns the mean of `overlaps`, which must not be empty.
  double meanOverlap() const { return meanOf(overlaps); }

 private:
  static double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

inline bool isFinite(const lab::BodyState& state) {
  return std::isfinite(state.position.x) && std::isfinite(state.position.y) && std::isfinite(state.angle);
}

inline void judge(const lab::Scene& scene, const lab::Simulation& simulation, bool measure, Run& result) {
  const std::vector<lab::BodyState> states = lab::statesOf(scene, simulation);
  result.failed = std::max(result.failed, lab::countLost(scene, simulation));
  if (!measure || !std::all_of(states.begin(), states.end(), isFinite)) return;
  ++result.looks;
  if (scene.collides) result.overlaps.push_back(lab::deepestOverlap(scene.bodies, states));
  result.joint_error = std::max(result.joint_error, lab::widestHinge(scene, states));
}

/// Throws std::runtime_error if a body is not where the scene says, for example because the engine refused
/// it.
inline void demandStart(const lab::Scene& scene, const lab::Simulation& simulation) {
  constexpr double kRounding = 1e-4;  // of float
  const std::vector<lab::BodyState> states = lab::statesOf(scene, simulation);
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!(length(states[i].position - scene.bodies[i].position) < kRounding))
      throw std::runtime_error("a body of a scene is elsewhere");
  }
}

/// Runs all ticks of the scene, in `substeps` parts each, and checks after each tenth. Stops after the tick
/// in which the engine's CPU time exceeds `most_seconds`.
inline Run run(const lab::Scene& scene, lab::Simulation& simulation, int substeps, double most_seconds) {
  Run result;
  double left_ms = most_seconds * 1e3;
  for (int tick = 1; tick <= scene.ticks && !result.cut; ++tick) {
    const double begin = cpuNanoseconds();
    simulation.step(scene.tick, substeps);
    const double ms = (cpuNanoseconds() - begin) / 1e6;
    result.tick_ms.push_back(ms);
    left_ms -= ms;
    result.cut = left_ms < 0 && tick < scene.ticks;
    const bool look = tick % lab::kTicksPerLook == 0;
    if (look || result.cut || tick == scene.ticks) judge(scene, simulation, look, result);
  }
  return result;
}

}  // namespace bench::physics
