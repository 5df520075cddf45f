// Problem 27: bodies on hinges: a chain with a heavy end, and a net.
#include <algorithm>
#include <string>
#include <vector>

#include "BenchScene.h"
#include "Problem.h"
#include "physics/Overlap.h"
#include "physics/Scenes.h"

namespace lab {
namespace {

Case hanging(const std::string& name, const std::string& label, const heaps::Scene& scene) {
  Case its_case(name, label, sceneOf(scene));
  its_case.is_crowd = true;
  its_case.draws_levels = true;
  its_case.most_substeps = 16;
  its_case.judge = [scene, own = its_case.scene](const Trial& trial) {
    double widest = 0;
    const SimulationPtr end = trial.run(own, [&](int tick, const Simulation& simulation) {
      if (tick % kTicksPerLook == 0)
        widest = std::max(widest, heaps::widestHinge(scene, posesOf(scene, simulation)));
    });
    return std::vector<double>{widest, static_cast<double>(end->frozen())};
  };
  return its_case;
}

std::vector<Metric> metrics(double target, double fast_target) {
  return {{"joint_error_m", "widest hinge at any look, m", target, 1e-15, fast_target},
          {"frozen", "bodies that froze", 0, 0, 0}};
}

Case chain() {
  Case swinging = hanging("chain100", "a chain of 20 links", heaps::makeChain100());
  swinging.metrics = metrics(1e-9, -1);
  swinging.cpu_bounds = {{"cpu_ratio", "box2d", kPeerSteps, 2, -1}};
  return swinging;
}

Case net() {
  Case falling = hanging("grid100", "a net of 100 × 100 discs", heaps::makeGrid100());
  falling.metrics = metrics(-1, .4);
  falling.cpu_bounds = {
      {"cpu_ratio", "box2d", kPeerSteps, 1, .5},
      {.name = "first_tick", .method = "", .target = 3, .fast_target = 3, .is_of_later = true}};
  falling.most_substeps = 8;
  return falling;
}

// Runs long enough for the net to fall as far as its hinges allow.
Case longNet() {
  constexpr int kTicks = 300;
  constexpr double kBounded = 10;  // m; a tenth of the net's side: with less, it has not come apart
  heaps::Scene scene = heaps::makeGrid100();
  scene.ticks = kTicks;
  Case falling = hanging("grid100_long", "the net for 10 s", scene);
  falling.metrics = metrics(kBounded, kBounded);
  falling.long_run = true;
  falling.draws_levels = false;
  falling.most_substeps = 4;
  return falling;
}

// 20 links of 1 × 0.25 m, hinged end to end and to the world, with a box of 100 times a link's mass at the
// free end, which falls from rest, 10 s; and a net of 100 × 100 discs that are hinged to their neighbours
// (19,800 hinges), of which seven in the middle of the top row are fixed, 1 s and 10 s. Nothing touches.
// Correct: the two points that a hinge holds together stay together.
std::vector<Case> makeHinges() {
  return {longNet(), net(), chain()};
}

const RegisteredProblem problem("27", "hinges", makeHinges, "Chains and nets on hinges",
                                "A bridge, a chain and a net are what an author builds first with joints. "
                                "The chain is what a direct solution of trees is for; the net has 9,801 "
                                "loops, which is more than one can solve for directly in a tick.");

}  // namespace
}  // namespace lab
