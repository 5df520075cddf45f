// The cost of a body, depending on the features that it uses. Each case is a column of the page "cost".
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "ElapsedTime.h"
#include "Path.h"
#include "tests/support/RunProgram.h"

namespace lab {
namespace {

constexpr int kBodies = 1000;
constexpr int kRow = 32;
constexpr double kApart = 3;
constexpr int kSettled = 30;  // ticks after which resting bodies are asleep
constexpr int kTicks = 20;    // measured ticks
constexpr int kWindows = 5;

// Returns valgrind's count of instructions, which is equal in every run, however busy the machine is.
double instructionsOf(const std::string& name, const std::string& method, int ticks) {
  const std::string command = "valgrind --tool=callgrind --callgrind-out-file=/dev/null '" +
                              std::filesystem::read_symlink("/proc/self/exe").string() + "' --work cost " +
                              name + " " + method + " " + std::to_string(ticks) + " 2>&1";
  const auto [code, output] = naiad::test::runProgram(command);
  const std::string label = "Collected : ";
  const std::size_t at = output.find(label);
  if (code != 0 || at == std::string::npos) throw Failure("valgrind does not count");
  return std::stod(output.substr(at + label.size()));
}

Case layer(const std::string& name, const std::string& label, void (*dress)(Scene&)) {
  Case bodies;
  bodies.name = name;
  for (int i = 0; i < kBodies; ++i) {
    bodies.scene.bodies.push_back(point({kApart * (i % kRow), kApart * (i / kRow)}, {0.01, 0.02}));
  }
  bodies.scene.ticks = kTicks;
  dress(bodies.scene);
  bodies.most_substeps = 1;
  bodies.metrics = {{"ns_per_body", label, -1, 0, ""}, {"instructions_per_body", label, -1, 0, ""}};
  bodies.judge = [scene = bodies.scene, name](const Trial& trial) {
    const SimulationPtr simulation = trial.build(scene);
    for (int tick = 0; tick < kSettled; ++tick) simulation->step(scene.tick, 1);
    std::array<double, kWindows> times;
    for (double& time : times) {
      const double start = bench::cpuNanoseconds();
      for (int tick = 0; tick < kTicks; ++tick) simulation->step(scene.tick, 1);
      time = (bench::cpuNanoseconds() - start) / (kTicks * static_cast<double>(kBodies));
    }
    std::sort(times.begin(), times.end());
    const double more = instructionsOf(name, trial.method().name, kSettled + kTicks) -
                        instructionsOf(name, trial.method().name, kSettled);
    return std::vector<double>{times[kWindows / 2], more / (kTicks * static_cast<double>(kBodies))};
  };
  return bodies;
}

void addShapes(Scene& scene) {
  for (Body& body : scene.bodies) body.shapes = {{Shape::Kind::CIRCLE, 0.5, {}}};
}

// Puts boxes on shelves.
void lay(Scene& scene, bool rotates) {
  constexpr double kHalf = 0.5;
  for (Body& body : scene.bodies) {
    body.shapes = {{Shape::Kind::BOX, 0, {kHalf, kHalf}, {}}};
    body.velocity = {};
    body.friction = 0.5;
    body.rotates = rotates;
  }
  for (int row = 0; kRow * row < kBodies; ++row) {
    Body shelf = wall({kApart * kRow / 2, kApart * row - 1.5 * kHalf}, {kApart * kRow, kHalf / 2});
    shelf.friction = 0.5;
    scene.bodies.push_back(shelf);
  }
  scene.gravity = {0, -10};
}

Problem make() {
  Problem problem;
  problem.title = "What a body costs";
  problem.text =
      "1000 bodies 3 m apart, one step a tick, after 30 ticks: nanoseconds (the median of five times 20 "
      "ticks) and instructions (counted by valgrind, the same in every run) per body and tick.";
  problem.reference = "none: this is cost";
  problem.kind = Problem::Kind::COST;
  problem.cases = {
      layer("object", "no body: an Object that moves by itself, in a world without a layer",
            [](Scene& scene) { scene.massless = true; }),
      layer("bare", "a body that moves, no shape", [](Scene&) {}),
      layer("gravity", "with gravity",
            [](Scene& scene) {
              scene.gravity = {0, -10};
            }),
      layer("drag", "with linear drag",
            [](Scene& scene) {
              for (Body& body : scene.bodies) body.linear_drag = 0.1;
            }),
      layer("field", "with a force field of the game",
            [](Scene& scene) { scene.field = [](double, const BodyState& s) { return -1.0 * s.position; }; }),
      layer("shape", "with a shape", addShapes),
      layer("rotation", "with a shape that rotates",
            [](Scene& scene) {
              addShapes(scene);
              for (Body& body : scene.bodies) {
                body.rotates = true;
                body.spin = 1;
              }
            }),
      layer("spring", "on a spring to a point",
            [](Scene& scene) {
              for (int i = 0; i < kBodies; ++i) {
                const Vec at = scene.bodies[static_cast<std::size_t>(i)].position;
                scene.joints.push_back(spring(-1, at - Vec{1, 0}, i, at, 10));
                scene.joints.back().damping = 1;
              }
            }),
      layer("pendulum", "on a rod to a point",
            [](Scene& scene) {
              scene.gravity = {0, -10};
              for (int i = 0; i < kBodies; ++i) {
                Body& body = scene.bodies[static_cast<std::size_t>(i)];
                body.velocity = {};
                scene.joints.push_back(rod(-1, body.position - Vec{1, 0}, i, body.position));
              }
            }),
      layer("pairs", "in pairs on a rod",
            [](Scene& scene) {
              for (int i = 0; i + 1 < kBodies; i += 2) {
                scene.bodies[static_cast<std::size_t>(i)].velocity = {0, 1};
                scene.joints.push_back(rod(i, scene.bodies[static_cast<std::size_t>(i)].position, i + 1,
                                           scene.bodies[static_cast<std::size_t>(i) + 1].position));
              }
            }),
      layer("resting", "a box at rest on a shelf", [](Scene& scene) { lay(scene, false); }),
      layer("resting_rotating", "the same, free to rotate", [](Scene& scene) { lay(scene, true); }),
  };
  return problem;
}

const RegisteredProblem problem("cost", "layers", make);

}  // namespace
}  // namespace lab
