// One run of a scene in one engine: the time of each tick, and the errors found.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "../ElapsedTime.h"
#include "Overlap.h"
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

inline bool isFinite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.cosine) &&
         std::isfinite(pose.sine);
}

inline std::vector<Pose> posesOf(const Scene& scene, const Simulation& simulation) {
  std::vector<Pose> poses;
  poses.reserve(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) poses.push_back(simulation.pose(i));
  return poses;
}

inline int countFailed(const Scene& scene, const Simulation& simulation, const std::vector<Pose>& poses) {
  int failed = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (scene.bodies[i].motion != Motion::DYNAMIC) continue;
    if (!isFinite(poses[i]) || simulation.isFrozen(i) || !scene.room.holds(poses, poses[i])) ++failed;
  }
  return failed;
}

inline void judge(const Scene& scene, const Simulation& simulation, bool measure, Run& result) {
  const std::vector<Pose> poses = posesOf(scene, simulation);
  result.failed = std::max(result.failed, countFailed(scene, simulation, poses));
  if (!measure || !std::all_of(poses.begin(), poses.end(), isFinite)) return;
  ++result.looks;
  if (scene.collide) result.overlaps.push_back(deepestOverlap(scene.bodies, poses));
  result.joint_error = std::max(result.joint_error, widestHinge(scene, poses));
}

/// Runs all ticks of the scene, and checks after each tenth. Stops after the tick in which the engine's CPU
/// time exceeds `most_seconds`.
inline Run run(const Scene& scene, Simulation& simulation, double most_seconds) {
  Run result;
  double left_ms = most_seconds * 1e3;
  for (int tick = 1; tick <= scene.ticks && !result.cut; ++tick) {
    const double begin = cpuNanoseconds();
    simulation.tick();
    const double ms = (cpuNanoseconds() - begin) / 1e6;
    result.tick_ms.push_back(ms);
    left_ms -= ms;
    result.cut = left_ms < 0 && tick < scene.ticks;
    const bool look = tick % 10 == 0;
    if (look || result.cut || tick == scene.ticks) judge(scene, simulation, look, result);
  }
  return result;
}

}  // namespace bench::physics
