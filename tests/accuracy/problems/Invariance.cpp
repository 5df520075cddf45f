// Problem 16: scenes far from the origin. Problem 17: a closed system, whose momentum must not change.
#include <cmath>
#include <random>

#include "Path.h"

namespace lab {
namespace {

Scene farScene(double distance) {
  constexpr int kTicks = 150;
  Scene scene;
  scene.bodies = {point({0, 10}, {1, 0.3}), ball({5, 5}, {0.5, 0}, 0.5), ground(50, 0, 0.8)};
  scene.bodies[1].restitution = 0.8;
  scene.field = [](double, const BodyState& state) { return state.position.y > 8 ? Vec{} : Vec{0, -10}; };
  scene.origin = {distance, -distance};
  scene.ticks = kTicks;
  return scene;
}

Case away(double distance) {
  Case moved(power(distance), power(distance) + " m away", farScene(distance));
  moved.metrics = {{"slow_path", "largest distance from the path at the origin, of its length", 0, 1e-16},
                   {"bounce_path", "the same for a bouncing ball, of the height", 0, 1e-16}};
  moved.judge = [distance](const Trial& trial) {
    Path right[2] = {{{}}, {{}}};
    const Scene home = farScene(0);
    trial.run(home, [&](int, const Simulation& simulation) {
      for (const int i : {0, 1}) right[i].push_back(positionOf(simulation, i));
    });
    const Scene scene = farScene(distance);
    const double scales[2] = {std::hypot(1, 0.3) * scene.duration(), 5};
    return trial.largest(scene, [&](int tick, const Simulation& simulation) {
      std::vector<double> errors;
      for (const int i : {0, 1}) {
        const std::vector<double> now = positionOf(simulation, i);
        const std::vector<double>& then = right[i][static_cast<std::size_t>(tick)];
        errors.push_back(std::hypot(now[0] - then[0], now[1] - then[1]) / scales[i]);
      }
      return errors;
    });
  };
  return moved;
}

// A body at 1 m/s and a bouncing ball, 5 s, at a distance in x and y from the origin. Correct: this
// method's run at the origin: translation changes nothing.
std::vector<Case> makeFar() {
  return {away(1e4), away(1e6), away(1e9)};
}

constexpr double kRadius = 0.5;

// 100 discs of 1 kg that spin and rush together, with restitution 0.5 and friction 0.5, without gravity: 1000
// ticks. Correct: momentum stays.
std::vector<Case> makeClosed() {
  constexpr int kSide = 10;
  Case swarm;
  std::mt19937_64 bits(17);
  const auto random = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; };
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec place{1.5 * (i % kSide) - 6.75, 1.5 * (i / kSide) - 6.75};
    Body disc = ball(place, -0.3 * place + Vec{0.5 * random() + 0.2, 0.5 * random()}, kRadius);
    disc.spin = random();
    disc.rotates = true;
    disc.friction = 0.5;
    disc.restitution = 0.5;
    swarm.scene.bodies.push_back(disc);
  }
  swarm.scene.ticks = 1000;
  swarm.metrics = {{"momentum", "largest change of momentum, of Σ|p| at the start", 1e-12, 1e-17}};
  swarm.judge = [scene = swarm.scene](const Trial& trial) {
    const Whole start = motionOf(scene, *trial.build(scene));
    return trial.largest(scene, [&](int, const Simulation& simulation) {
      const Vec now = motionOf(scene, simulation).momentum;
      return std::vector<double>{length(now - start.momentum) / start.sum};
    });
  };
  return {swarm};
}

const RegisteredProblem distant(
    "16", "far", makeFar, "Far from the origin",
    "A map may be as large as it likes, and physics must be the same everywhere in it.");
const RegisteredProblem closed("17", "closed", makeClosed, "A closed system",
                               "What no force acts upon keeps its momentum; what drifts over minutes shows "
                               "in a server that runs for weeks.");

}  // namespace
}  // namespace lab
