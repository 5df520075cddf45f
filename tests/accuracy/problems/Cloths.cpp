// Problem 28: cloths that hang by two corners.
#include <algorithm>
#include <string>

#include "Problem.h"

namespace lab {
namespace {

constexpr double kMesh = 1;  // side of a mesh, m

// Returns the largest stretch of a thread relative to its rest length.
double stretchOf(const Scene& scene, const Simulation& simulation) {
  double most = 0;
  for (const Joint& joint : scene.joints) {
    const double now = length(simulation.body(joint.b).position - simulation.body(joint.a).position);
    most = std::max(most, now / kMesh - 1);
  }
  return most;
}

Scene clothOf(int side) {
  Scene scene;
  scene.gravity = {0, -18};  // m/s²; 0.02 cells per tick²
  scene.ticks = 300;
  scene.cloths = {{side, side, kMesh, 1, 4500}};  // stiffness: 5 cells per tick²
  for (int i = 0; i < side * side; ++i) {
    scene.bodies.push_back(point({kMesh * (i % side), -kMesh * (i / side)}, {}, 1.0 / (side * side)));
    if (i == 0 || i == side - 1) scene.bodies.back().motion = Motion::FIXED;
  }
  for (int i = 0; i < side * side; ++i) {
    const Vec at = scene.bodies[static_cast<std::size_t>(i)].position;
    if (i % side + 1 < side) scene.joints.push_back(rod(i, at, i + 1, at + Vec{kMesh, 0}));
    if (i + side < side * side) scene.joints.push_back(rod(i, at, i + side, at - Vec{0, kMesh}));
  }
  return scene;
}

Case cloth(int side) {
  Case hung(std::to_string(side), std::to_string(side) + " × " + std::to_string(side) + " nodes",
            clothOf(side));
  hung.is_crowd = true;
  hung.long_run = side > 50;
  hung.most_substeps = side > 50 ? 4 : 16;
  hung.metrics = {{"stretch", "largest relative stretch of a thread over 10 s", 0.05, 1e-15},
                  {"frozen", "cloths that froze", 0, 0}};
  hung.judge = [scene = hung.scene](const Trial& trial) {
    double stretch = 0;
    const SimulationPtr end = trial.run(scene, [&](int /*tick*/, const Simulation& simulation) {
      stretch = std::max(stretch, stretchOf(scene, simulation));
    });
    return std::vector<double>{stretch, static_cast<double>(end->frozen())};
  };
  return hung;
}

// Cloths of 25 × 25, 50 × 50 and 100 × 100 nodes with meshes of 1 m, held flat and hung by their two upper
// corners, fall for 10 s. For peers they are points on rods. Correct: no thread gets longer.
std::vector<Case> makeCloths() {
  constexpr double kDearestTick = 60'000;  // limit of the slowest tick, µs
  std::vector<Case> cases = {cloth(25), cloth(50), cloth(100)};
  cases.back().tick_bound = {.base_us = kDearestTick, .each_us = 0};
  return cases;
}

const RegisteredProblem problem(
    "28", "cloths", makeCloths, "Cloths",
    "A cloth is the stiffest thing that an author makes without thinking of it: the corners bear all of its "
    "weight, through threads of a ten-thousandth of it each.");

}  // namespace
}  // namespace lab
