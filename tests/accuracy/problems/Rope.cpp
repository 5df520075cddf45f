// Problem 11: a rope with a heavy end.
#include <algorithm>

#include "Path.h"

namespace lab {
namespace {

constexpr double kGravity = 10;

Case rope(double ratio) {
  constexpr int kLinks = 20;
  constexpr double kLink = 0.5;
  Case swinging("r" + power(ratio), "end mass " + power(ratio));
  swinging.draws_levels = true;
  Scene& scene = swinging.scene;
  for (int i = 0; i < kLinks; ++i) {
    scene.bodies.push_back(point({kLink * (i + 1), 0}, {}, i == kLinks - 1 ? ratio : 1));
    scene.joints.push_back(rod(i - 1, {kLink * i, 0}, i, {kLink * (i + 1), 0}));
  }
  scene.gravity = {0, -kGravity};
  scene.ticks = 300;
  double scale = 0;  // loss of potential energy if the whole rope hung straight down
  for (const Body& body : scene.bodies) scale += body.mass * kGravity * body.position.x;
  swinging.judge = [scene, scale](const Trial& trial) {
    return trial.largest(scene, [&](int, const Simulation& simulation) {
      Vec before;
      double energy = 0, stretch = 0;
      for (int i = 0; i < kLinks; ++i) {
        const BodyState state = simulation.body(i);
        stretch = std::max(stretch, std::abs(length(state.position - before) / kLink - 1));
        before = state.position;
        const double mass = scene.bodies[static_cast<std::size_t>(i)].mass;
        energy += mass * (dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y);
      }
      return std::vector<double>{stretch, std::abs(energy) / scale};
    });
  };
  // The unit should be XPBD with 20 sub-steps in a tick of 1/60 s, which are 40 in this tick; 32 is the next
  // lower number that is measured.
  if (ratio <= 1e3) swinging.cpu_bounds = {{"cpu_ratio", "xpbd", 32, 1.5}};
  swinging.metrics = {
      {"stretch", "largest relative stretch of a link over 10 s", ratio > 1e3 ? 0.1 : 1e-9, 1e-16},
      {"energy_drift", "largest |ΔE| / (potential energy of the fall)", -1, 1e-15}};
  return swinging;
}

// 20 rigid links of 0.5 m between points of 1 kg, the last of R kg; it is let go horizontally and swings for
// 10 s. Correct: links keep their length, and the whole its energy.
std::vector<Case> makeRope() {
  return {rope(1), rope(100), rope(1e3), rope(1e6)};
}

// The rope of problem 11. A cell is the largest relative stretch of a link over 10 s, in tenths: from 1 on it
// is a rubber band. Correct: links keep their length.
std::vector<Case> makeMap() {
  return mapOf(1e6, rope, {"stretch", "end mass, in links", -1, 0}, 0.1);
}

const RegisteredProblem rope_problem(
    "11", "rope", makeRope, "Rope with a heavy end",
    "A wrecking ball on a chain: peers stretch it like rubber, and a direct solution does not.");
const RegisteredProblem map("map-rope", "rope-map", makeMap, "What stays bounded: a rope's end mass × step",
                            "", Problem::Kind::MAP);

}  // namespace
}  // namespace lab
