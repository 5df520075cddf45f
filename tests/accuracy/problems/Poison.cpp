// Problem 18: invalid values, such as NaN, and an extremely long tick. Neither may harm a pile.
#include <cstring>
#include <limits>

#include "Path.h"

namespace lab {
namespace {

constexpr int kTicks = 60;
constexpr int kPile = 5;
constexpr double kGravity = 10;

// A pile that the invalid values must not affect.
Scene pile() {
  Scene scene;
  for (int i = 0; i < kPile; ++i) scene.bodies.push_back(crate({0, 0.5 + i}, {0.5, 0.5}, 0.5));
  scene.bodies.push_back(ground(50, 0.5));
  scene.gravity = {0, -kGravity};
  scene.ticks = kTicks;
  return scene;
}

bool same(const BodyState& a, const BodyState& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Returns the pile's final state. Nothing is checked during the run, because invalid numbers may occur.
std::vector<BodyState> runPile(const Trial& trial, const Scene& scene) {
  const SimulationPtr simulation = trial.build(scene);
  for (int tick = 0; tick < scene.ticks; ++tick) simulation->step(scene.tick, trial.substeps());
  std::vector<BodyState> states;
  for (int i = 0; i < kPile; ++i) states.push_back(simulation->body(i));
  return states;
}

Case poisoned(const std::string& name, const Body& poison) {
  Case bad(name, "", pile());
  bad.scene.bodies.push_back(poison);
  bad.metrics = {{"changed", "crates of a pile 20 m away that are not bit-identical", 0, 0}};
  bad.judge = [scene = bad.scene](const Trial& trial) {
    const std::vector<BodyState> right = runPile(trial, pile());
    const std::vector<BodyState> now = runPile(trial, scene);
    int changed = 0;
    for (std::size_t i = 0; i < right.size(); ++i) changed += same(right[i], now[i]) ? 0 : 1;
    return std::vector<double>{static_cast<double>(changed)};
  };
  return bad;
}

Case spike() {
  constexpr double kLong = 1e4;  // length of a tick, s
  Case bad("dt_spike", "a tick of a thousand", pile());
  bad.metrics = {{"displaced", "crates more than 1 m from their place after a tick of 1e4 s", 0, 0}};
  bad.judge = [scene = bad.scene](const Trial& trial) {
    const SimulationPtr simulation = trial.build(scene);
    for (int tick = 0; tick < kTicks; ++tick) {
      simulation->step(tick == kTicks / 2 ? kLong : scene.tick, trial.substeps());
    }
    int displaced = 0;
    for (int i = 0; i < kPile; ++i) {
      const double distance =
          length(simulation->body(i).position - scene.bodies[static_cast<std::size_t>(i)].position);
      displaced += distance <= 1 ? 0 : 1;  // also counts NaN
    }
    return std::vector<double>{static_cast<double>(displaced)};
  };
  return bad;
}

// A ball 20 m from a pile of 5 crates has a position, velocity, mass or size that no ball can have. A crash
// or an endless loop is a failure. Correct: the pile without that ball.
std::vector<Case> make() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Body good = ball({20, 5}, {-1, 0}, 0.5);
  const auto with = [&good](auto change) {
    Body body = good;
    change(body);
    return body;
  };
  std::vector<Case> cases = {
      poisoned("nan_position", with([](Body& b) { b.position.x = kNaN; })),
      poisoned("nan_velocity", with([](Body& b) { b.velocity.x = kNaN; })),
      poisoned("inf_velocity", with([](Body& b) { b.velocity.x = kInfinity; })),
      poisoned("1e30_velocity", with([](Body& b) { b.velocity.x = -1e30; })),
      poisoned("1e30_position", with([](Body& b) { b.position.x = 1e30; })),
      poisoned("denormal_mass", with([](Body& b) { b.mass = 1e-310; })),
      poisoned("zero_mass", with([](Body& b) { b.mass = 0; })),
      poisoned("nan_mass", with([](Body& b) { b.mass = kNaN; })),
      poisoned("zero_size", with([](Body& b) { b.shapes[0].radius = 0; })),
      poisoned("1e30_size", with([](Body& b) { b.shapes[0].radius = 1e30; })),
      spike(),
  };
  for (Case& bad : cases) bad.most_substeps = 8;
  return cases;
}

const RegisteredProblem problem("18", "bad-numbers", make, "Bad numbers",
                                "A game's mistake may cost the object that it was made with, and no other.");

}  // namespace
}  // namespace lab
