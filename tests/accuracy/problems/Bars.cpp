// Problem 21: rotating bars that are shot at long walls.
#include <algorithm>
#include <array>
#include <cmath>

#include "Path.h"
#include "shared/values/SplitMix64.h"

namespace lab {
namespace {

constexpr Vec kBar{0.3, 0.05};  // half width and half height
constexpr double kWallAt = 50;  // x of the wall, m
constexpr double kHalfWall = 0.5;
constexpr double kHeavy = 100;         // the wall's mass relative to a bar's
constexpr double kFastest = 6;         // the highest speed is 10 to this power, in cells per tick
constexpr double kTicksAfter = 2;      // ticks after its arrival, at whose end the bar must have met the wall
constexpr double kMaxTicksToWall = 3;  // the bar starts so near that it arrives within these ticks
constexpr double kTurned = 0.5;  // rad, or rad per tick; if the wall turns more, the bar may pass its end
constexpr int kShots = 1000;
constexpr int kProductShots = 10000;

template <std::size_t N>
double oneOf(const std::array<double, N>& all, naiad::SplitMix64& random) {
  return all.at(static_cast<std::size_t>(random.unit() * N));
}

Body wallOf(Motion motion, double length, double speed) {
  Body made = wall({kWallAt, 0}, {kHalfWall, 0.5 * length});
  made.motion = motion;
  if (motion == Motion::KINEMATIC) made.velocity = {-0.5 * speed, 0};
  if (motion == Motion::DYNAMIC) {
    made.mass = kHeavy;
    made.rotates = true;
  }
  return made;
}

Scene shot(Motion motion, int number, naiad::SplitMix64& random) {
  const double per_tick = std::pow(10, kFastest * random.unit());
  const double length = oneOf(std::array{10.0, 200.0, 3000.0, 40'000.0, 200'000.0}, random);
  Body target = wallOf(motion, length, per_tick / kTick);
  const double closing = per_tick * (motion == Motion::KINEMATIC ? 1.5 : 1);
  const double away = std::min(kWallAt, 2 + kMaxTicksToWall * closing);
  Body bar = box({kWallAt - away, 0.4 * length * (2 * random.unit() - 1)}, kBar);
  bar.rotates = true;
  bar.fast = true;
  bar.velocity = {per_tick / kTick, 0};
  bar.angle = 0.37 * number;
  bar.spin = oneOf(std::array{0.0, 1.0, 100.0, 1e5}, random) / kTick;
  bar.restitution = target.restitution = oneOf(std::array{0.0, 0.3, 1.0}, random);
  bar.friction = target.friction = oneOf(std::array{0.0, 0.6}, random);
  Scene scene;
  scene.bodies = {bar, target};
  scene.ticks = static_cast<int>(std::ceil(away / closing) + kTicksAfter);
  return scene;
}

// True if the bar is behind the wall and not beyond its ends. Uses the wall's axes, because the wall may
// turn.
bool isThrough(const Scene& scene, const BodyState& bar, const BodyState& target) {
  const Vec d = bar.position - target.position;
  const double c = std::cos(target.angle), s = std::sin(target.angle);
  return c * d.x + s * d.y > kHalfWall && std::abs(c * d.y - s * d.x) < scene.bodies[1].shapes[0].half.y;
}

double energyOf(const Body& body, const BodyState& state) {
  if (body.motion != Motion::DYNAMIC) return 0;
  const double inertia = body.mass * inertiaOf(body.shapes[0]);
  return 0.5 * (body.mass * dot(state.velocity, state.velocity) + inertia * state.spin * state.spin);
}

Case against(Motion motion, const std::string& name) {
  Case shots(name, "a " + name + " wall");
  naiad::SplitMix64 first(1);
  shots.scene = shot(motion, 1, first);
  shots.metrics = {
      {"through", "part of the shots that go through", 0, 1e-6},
      {"unmet", "part of the shots that never arrive", 0, 1e-6},
      {"energy_gain", "largest gain of energy, relative", motion == Motion::KINEMATIC ? -1.0 : 1e-6, 1e-15}};
  shots.judge = [motion](const Trial& trial) {
    const int count = trial.method().kind == Method::Kind::PRODUCT ? kProductShots : kShots;
    naiad::SplitMix64 random(21);
    int through = 0, unmet = 0;
    double gain = 0;
    for (int i = 0; i < count; ++i) {
      const Scene scene = shot(motion, i, random);
      bool has_turned = false, has_passed = false;
      const SimulationPtr start = trial.build(scene);
      const SimulationPtr end = trial.run(scene, [&](int /*tick*/, const Simulation& simulation) {
        const BodyState its = simulation.body(1);
        has_turned = has_turned || std::abs(its.angle) > kTurned || std::abs(its.spin) * kTick > kTurned;
        has_passed = has_passed || (!has_turned && isThrough(scene, simulation.body(0), its));
      });
      const BodyState bar = end->body(0), target = end->body(1);
      const double before = energyOf(scene.bodies[0], start->body(0));
      gain =
          std::max(gain, (energyOf(scene.bodies[0], bar) + energyOf(scene.bodies[1], target)) / before - 1);
      if (has_passed) {
        ++through;
      } else if (end->contacts() == 0) {
        ++unmet;
      }
    }
    return std::vector<double>{static_cast<double>(through) / count, static_cast<double>(unmet) / count,
                               gain};
  };
  return shots;
}

// A bar of 0.6 × 0.1 m that turns by 0, 1, 100 or 10⁵ rad per tick is shot at 1 to 10⁶ m per tick
// (log-uniform) at a wall 1 m thick and 10 to 200,000 m long. The wall is static, or kinematic and
// approaching at half the bar's speed, or dynamic and 100 times as heavy as the bar. The restitution is 0,
// 0.3 or 1, and the friction is 0 or 0.6. 1,000 shots (the product: 10,000), each observed until two ticks
// after the latest time of arrival. Correct: every bar hits the wall, stays on its side, and gains no energy
// if the wall is static.
std::vector<Case> make() {
  return {against(Motion::FIXED, "static"), against(Motion::KINEMATIC, "kinematic"),
          against(Motion::DYNAMIC, "dynamic")};
}

const RegisteredProblem problem(
    "21", "bars", make, "Bars against long walls",
    "A bar that turns is harder than a ball: its ends are faster than its middle.");

}  // namespace
}  // namespace lab
