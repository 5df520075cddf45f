// What a body costs by what it uses: the columns of the cost page.
#include "Clock.h"
#include "Path.h"

namespace lab {

namespace {

constexpr int kBodies = 1000;
constexpr int kTicks = 100;
constexpr double kApart = 3;

Case layer(const std::string& name, const std::string& label, void (*dress)(Scene&)) {
  Case bodies;
  bodies.name = name;
  for (int i = 0; i < kBodies; ++i) {
    Body body;
    body.position = {kApart * (i % 32), kApart * (i / 32)};
    body.velocity = {0.01, 0.02};
    bodies.scene.bodies.push_back(body);
  }
  bodies.scene.ticks = kTicks;
  dress(bodies.scene);
  bodies.most_substeps = 1;
  bodies.metrics = {{"ns_per_body", label, -1, 0, ""}};
  bodies.judge = [scene = bodies.scene](const Trial& trial) {
    const SimulationPtr simulation = trial.build(scene);
    simulation->step(scene.tick, 1);
    const double start = bench::cpuNanoseconds();
    for (int tick = 1; tick < kTicks; ++tick) simulation->step(scene.tick, 1);
    return std::vector<double>{(bench::cpuNanoseconds() - start) /
                               ((kTicks - 1) * static_cast<double>(kBodies))};
  };
  return bodies;
}

void addShapes(Scene& scene) {
  for (Body& body : scene.bodies) body.shapes = {{Shape::Kind::CIRCLE, 0.5, {}}};
}

Problem make() {
  Problem problem;
  problem.title = "What a body costs";
  problem.text = "1000 bodies 3 m apart that never meet, one step a tick: nanoseconds per body and tick.";
  problem.reference = "none: this is time";
  problem.kind = Problem::Kind::COST;
  problem.cases = {
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
  };
  return problem;
}

const RegisteredProblem problem("cost", "layers", make);

}  // namespace

}  // namespace lab
