// 11: a rope with a heavy end. 11b: the catenary and the cantilever.
#include <algorithm>

#include "Path.h"
#include "Real.h"

namespace lab {

namespace {

constexpr double kGravity = 10;

void addRod(Scene& scene, int a, Vec from, int b, Vec to) {
  Joint rod;
  rod.a = a;
  rod.b = b;
  rod.anchor_a = from;
  rod.anchor_b = to;
  scene.joints.push_back(rod);
}

Case rope(double ratio) {
  constexpr int kLinks = 20;
  constexpr double kLink = 0.5;
  Case swinging;
  swinging.name = "r" + power(ratio);
  Scene& scene = swinging.scene;
  for (int i = 0; i < kLinks; ++i) {
    Body point;
    point.position = {kLink * (i + 1), 0};
    point.mass = i == kLinks - 1 ? ratio : 1;
    scene.bodies.push_back(point);
    addRod(scene, i - 1, {kLink * i, 0}, i, point.position);
  }
  scene.gravity = {0, -kGravity};
  scene.ticks = 300;
  double scale = 0;  // what the energy could change by, if all hung straight down
  for (const Body& body : scene.bodies) scale += body.mass * kGravity * body.position.x;
  swinging.judge = [scene, scale](const Trial& trial) {
    double stretch = 0;
    double drift = 0;
    trial.run(scene, [&](int, const Simulation& simulation) {
      Vec before;
      double energy = 0;
      for (int i = 0; i < kLinks; ++i) {
        const BodyState state = simulation.body(i);
        stretch = std::max(stretch, std::abs(length(state.position - before) / kLink - 1));
        before = state.position;
        const double mass = scene.bodies[static_cast<std::size_t>(i)].mass;
        energy += mass * (dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y);
      }
      drift = std::max(drift, std::abs(energy) / scale);
    });
    return std::vector<double>{stretch, drift};
  };
  // 20 sub-steps of a tick of 1/60 s are 40 of this one; the next lower count is measured.
  if (ratio <= 1e3) swinging.cpu_bounds = {{"cpu_ratio", "xpbd", 32, 1.5}};
  const std::string peers = ratio == 1     ? "Box2D .097, XPBD 20×1 .0039, direct solve 4e-13"
                            : ratio == 100 ? "Box2D .14, XPBD 20×1 .018, direct solve 4e-13"
                            : ratio == 1e3 ? "Box2D .89, XPBD 20×1 .043, direct solve 4e-13"
                                           : "";
  swinging.metrics = {
      {"stretch", "largest relative stretch of a link over 10 s", ratio > 1e3 ? 0.1 : 1e-10, 1e-16, peers},
      {"energy_drift", "largest |ΔE| / (potential energy of the fall)", -1, 1e-15, "direct solve ≤ 2e-2"}};
  return swinging;
}

Problem makeRope() {
  Problem problem;
  problem.title = "Rope with a heavy end";
  problem.text =
      "20 rigid links of 0.5 m between points of 1 kg, the last of R kg; it is let go horizontally and "
      "swings for 10 s.";
  problem.reference = "links keep their length, and the whole its energy";
  problem.cases = {rope(1), rope(100), rope(1e3), rope(1e6)};
  return problem;
}

// The a of y = a cosh(x/a) for a rope of this length between two points at one height, by Newton.
double catenaryOf(double span, double its_length) {
  Quad a = span / 2;
  for (int i = 0; i < 200; ++i) {
    const Quad u = Quad(span) / 2 / a;
    const Quad sinh_u = (exp(u) - exp(-u)) / 2;
    const Quad cosh_u = (exp(u) + exp(-u)) / 2;
    a -= (2 * a * sinh_u - its_length) / (2 * sinh_u - 2 * u * cosh_u);
  }
  return static_cast<double>(a);
}

Case catenary(int links) {
  constexpr double kSpan = 10;
  constexpr double kLength = 12;
  constexpr double kDrag = 2;  // 1/s
  Case hanging;
  hanging.name = "catenary" + std::to_string(links);
  Scene& scene = hanging.scene;
  // From a V, whose arms are straight.
  const double depth = std::sqrt(kLength * kLength - kSpan * kSpan) / 2;
  const auto place = [&](int i) {
    const double part = 2.0 * i / links;  // 0 … 2
    return Vec{kSpan / 2 * (part - 1), -depth * std::min(part, 2 - part)};
  };
  for (int i = 1; i < links; ++i) {
    Body point;
    point.position = place(i);
    point.mass = kLength / links;
    point.linear_drag = kDrag * point.mass;
    scene.bodies.push_back(point);
    addRod(scene, i - 2, place(i - 1), i - 1, point.position);
  }
  addRod(scene, links - 2, place(links - 1), -1, place(links));
  scene.gravity = {0, -kGravity};
  scene.ticks = 600;
  const double a = catenaryOf(kSpan, kLength);
  const double sag = a * (std::cosh(kSpan / 2 / a) - 1);
  hanging.metrics = {{"sag", "relative error of the sag in the middle", 0.01, 0, ""}};
  hanging.judge = [scene, sag, links](const Trial& trial) {
    const SimulationPtr end = trial.run(scene);
    return std::vector<double>{std::abs(-end->body(links / 2 - 1).position.y / sag - 1)};
  };
  return hanging;
}

// Slender, and loaded so that it bends by a hundredth of its length: there the linear theory holds to 1e-4.
Beam slender(int elements) {
  Beam beam;
  beam.length = 10;
  beam.thickness = 0.25;
  beam.modulus = 1e7;
  beam.density = 100;
  beam.elements = elements;
  return beam;
}

double stiffnessOf(const Beam& beam) {
  return beam.modulus * std::pow(beam.thickness, 3) / 12;  // EI, for a depth of 1 m
}

Case bending(int elements) {
  Case bent;
  bent.name = "cantilever" + std::to_string(elements);
  Beam beam = slender(elements);
  const double deflection = beam.length / 100;
  beam.tip_force = deflection * 3 * stiffnessOf(beam) / std::pow(beam.length, 3);
  beam.damping = 1;
  bent.scene.beams = {beam};
  bent.scene.ticks = 1200;
  bent.metrics = {{"deflection", "relative error of the tip's deflection", 0.01, 0, ""}};
  bent.judge = [scene = bent.scene, deflection](const Trial& trial) {
    const SimulationPtr end = trial.run(scene);
    return std::vector<double>{std::abs(-end->body(0).position.y / deflection - 1)};
  };
  return bent;
}

Problem makeSoft() {
  Problem problem;
  problem.title = "Catenary and cantilever";
  problem.text =
      "A chain of 16, 32 and 64 rigid links, 12 m long, hangs between points 10 m apart: after 20 s with "
      "drag it is at "
      "rest. A beam of 10 m, clamped at one end, is bent by a force at the other.";
  problem.reference = "a cosh(x/a), which the chain approaches with (1/links)²; FL³/3EI";
  problem.cases = {catenary(16), catenary(32), catenary(64), bending(8), bending(16), bending(32)};
  return problem;
}

const RegisteredProblem rope_problem("11", "rope", makeRope);
const RegisteredProblem soft_problem("11b", "soft", makeSoft);

}  // namespace

}  // namespace lab
