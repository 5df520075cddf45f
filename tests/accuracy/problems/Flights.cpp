// Problem 1: a point thrown under gravity. Problem 2: linear and quadratic drag.
#include "Path.h"
#include "Systems.h"

namespace lab {
namespace {

constexpr int kTicks = 60;
constexpr double kGravity = 10;  // m/s²
constexpr Vec kThrown{3, 20};
constexpr double kLinear = 2;    // coefficient of linear drag, kg/s
constexpr double kStart = 10;    // initial speed, m/s
constexpr double kTerminal = 5;  // terminal speed, m/s
constexpr double kQuadratic = kGravity / (kTerminal * kTerminal);

// A point is thrown with (3, 20) m/s under 10 m/s² and flies for 2 s. Correct: x₀ + v₀t + ½gt², in quad
// precision.
std::vector<Case> makeBallistic() {
  Case flight;
  flight.scene.bodies = {point({}, kThrown)};
  flight.scene.gravity = {0, -kGravity};
  flight.scene.ticks = kTicks;
  Flight system;
  system.velocity = kThrown;
  system.gravity = kGravity;
  flight.scene.equations = equationsOf(system);
  flight.metrics = pathMetrics(1e-12, 1e-16);
  const Path path = pathOf(kTicks, [](Quad t) {
    return std::vector<Quad>{kThrown.x * t, kThrown.y * t - kGravity * t * t / 2};
  });
  flight.judge = alongPath(flight.scene, path, length({path.back()[0], path.back()[1]}),
                           [](const Simulation& s) { return positionOf(s); });
  return {flight};
}

Case linear() {
  Case gliding("linear", "linear drag");
  gliding.scene.bodies = {point({}, {kStart, 0})};
  gliding.scene.bodies[0].linear_drag = kLinear;
  gliding.scene.ticks = kTicks;
  Flight system;
  system.velocity = {kStart, 0};
  system.linear = kLinear;
  gliding.scene.equations = equationsOf(system);
  gliding.metrics = pathMetrics(1e-12, 1e-16);
  const Path path = pathOf(kTicks, [](Quad t) {
    return std::vector<Quad>{kStart / Quad(kLinear) * (1 - exp(-kLinear * t)), 0};
  });
  gliding.judge =
      alongPath(gliding.scene, path, path.back()[0], [](const Simulation& s) { return positionOf(s); });
  return gliding;
}

Case quadratic() {
  Case falling("quadratic", "quadratic drag");
  falling.scene.bodies = {Body()};
  falling.scene.gravity = {0, -kGravity};
  falling.scene.ticks = kTicks;
  falling.scene.field = [](double, const BodyState& state) {
    return -kQuadratic * length(state.velocity) * state.velocity;
  };
  Flight system;
  system.gravity = kGravity;
  system.quadratic = kQuadratic;
  falling.scene.equations = equationsOf(system);
  falling.metrics = pathMetrics(1e-8, 1e-16);
  // Compares position and speed, each relative to its own scale.
  const Path path = pathOf(kTicks, [](Quad t) {
    const Quad s = Quad(kGravity) * t / kTerminal;
    const Quad log_cosh = s + log((1 + exp(-2 * s)) / 2);
    return std::vector<Quad>{-Quad(kTerminal) / kGravity * log_cosh, -tanh(s)};
  });
  falling.judge = alongPath(falling.scene, path, std::abs(path.back()[0]), [](const Simulation& s) {
    const BodyState state = s.body(0);
    return std::vector<double>{state.position.y / kTerminal, state.velocity.y / kTerminal};
  });
  return falling;
}

// Linear: 1 kg slides from 10 m/s for 2 s with 2 kg/s of drag. Quadratic: 1 kg falls from rest for 2 s with a
// terminal speed of 5 m/s. Correct: (v₀/c)(1 − e^(−ct)); (v_t²/g) ln cosh(gt/v_t) and v_t tanh(gt/v_t), in
// quad precision.
std::vector<Case> makeDrag() {
  return {linear(), quadratic()};
}

const RegisteredProblem ballistic(
    "1", "ballistic", makeBallistic, "Ballistic flight",
    "Everything that is thrown flies like this; a fixed-step engine lands early by half a step.");
const RegisteredProblem drag("2", "drag", makeDrag, "Drag",
                             "Anything that slows down, from a leaf to a car. The closed form costs no "
                             "more than a step, and is right at any tick.");

}  // namespace
}  // namespace lab
