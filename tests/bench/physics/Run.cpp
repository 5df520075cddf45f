#include "Run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../ElapsedTime.h"
#include "Overlap.h"

namespace bench::physics {
namespace {

constexpr int kTicksPerLook = 10;

double mean(std::vector<double>::const_iterator begin, std::vector<double>::const_iterator end) {
  return std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
}

bool isFinite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.cosine) &&
         std::isfinite(pose.sine);
}

std::vector<Pose> posesOf(const Scene& scene, const Simulation& simulation) {
  std::vector<Pose> poses;
  poses.reserve(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) poses.push_back(simulation.pose(i));
  return poses;
}

int countFailed(const Scene& scene, const Simulation& simulation, const std::vector<Pose>& poses) {
  int failed = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (scene.bodies[i].motion != Motion::DYNAMIC) continue;
    if (!isFinite(poses[i]) || simulation.isFrozen(i) || !scene.room.holds(poses, poses[i])) ++failed;
  }
  return failed;
}

void judge(const Scene& scene, const Simulation& simulation, bool measure, Run& result) {
  const std::vector<Pose> poses = posesOf(scene, simulation);
  result.failed = std::max(result.failed, countFailed(scene, simulation, poses));
  if (!measure || !std::all_of(poses.begin(), poses.end(), isFinite)) return;
  ++result.looks;
  if (scene.collide) result.overlaps.push_back(deepestOverlap(scene.bodies, poses));
  result.joint_error = std::max(result.joint_error, widestHinge(scene, poses));
}

}  // namespace

double Run::meanMs(std::size_t ticks) const {
  return mean(tick_ms.begin(), tick_ms.begin() + static_cast<std::ptrdiff_t>(ticks));
}

double Run::worstMs() const {
  return *std::max_element(tick_ms.begin(), tick_ms.end());
}

double Run::meanOverlap() const {
  return mean(overlaps.begin(), overlaps.end());
}

Run run(const Scene& scene, Simulation& simulation, double most_seconds) {
  Run result;
  double left_ms = most_seconds * 1e3;
  for (int tick = 1; tick <= scene.ticks && !result.cut; ++tick) {
    const double begin = cpuNanoseconds();
    simulation.tick();
    const double ms = (cpuNanoseconds() - begin) / 1e6;
    result.tick_ms.push_back(ms);
    left_ms -= ms;
    result.cut = left_ms < 0 && tick < scene.ticks;
    const bool look = tick % kTicksPerLook == 0;
    if (look || result.cut || tick == scene.ticks) judge(scene, simulation, look, result);
  }
  return result;
}

}  // namespace bench::physics
