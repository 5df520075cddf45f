// Problem 30: springs and fields that pull a body while it touches another.
#include <algorithm>
#include <cmath>
#include <string>

#include "Path.h"

namespace lab {
namespace {

constexpr double kGravity = 10;
constexpr double kHalf = 0.5;
constexpr double kStart = 1;  // initial distance from the spring's anchor, m
constexpr int kTicks = 300;

enum class Pull { SPRING, FIELD };

// Pulls a crate on a floor by a spring or a field. `per_tick` is the stiffness in kg per tick².
Case pulled(Pull pull, double per_tick, const std::string& name) {
  const double stiffness = per_tick / (kTick * kTick);
  Case swinging(name + power(per_tick));
  swinging.label =
      std::string(pull == Pull::SPRING ? "spring" : "field") + ", k = " + power(per_tick) + " a tick²";
  Scene& scene = swinging.scene;
  const Vec centre{0, kHalf};
  scene.bodies = {crate({kStart, kHalf}, {kHalf, kHalf}, 0), ground(100, 0)};
  scene.gravity = {0, -kGravity};
  scene.ticks = kTicks;
  if (pull == Pull::FIELD) {
    scene.field = [stiffness](double, const BodyState& state) {
      return Vec{-stiffness * state.position.x, 0};
    };
  } else {
    scene.joints = {spring(-1, centre, 0, scene.bodies[0].position, stiffness)};
    scene.joints[0].rest_length = 0;
  }
  swinging.metrics = {{"energy_gain", "largest gain of energy, relative", 1e-6, 1e-15, -1},
                      {"sunk_m", "how far the centre came below the floor's top, m", 0, 1e-15, 0}};
  swinging.judge = [scene, stiffness, centre, pull](const Trial& trial) {
    const auto energyOf = [&](const BodyState& s) {
      const Vec off = s.position - centre;
      const double held = pull == Pull::FIELD ? off.x * off.x : dot(off, off);
      const double inertia = 2 * kHalf * kHalf / 3;
      return 0.5 * (dot(s.velocity, s.velocity) + inertia * s.spin * s.spin + stiffness * held) +
             kGravity * off.y;
    };
    const double start = 0.5 * stiffness * kStart * kStart;
    return trial.largest(scene, [&](int /*tick*/, const Simulation& simulation) {
      const BodyState s = simulation.body(0);
      return std::vector<double>{energyOf(s) / start - 1, -s.position.y};
    });
  };
  return swinging;
}

// A slow oscillation (0.1 rad per tick), which the ticks resolve, so it must not decay.
Case resolved(Pull pull, const std::string& name) {
  constexpr double kSlow = 0.01;
  Case swinging = pulled(pull, kSlow, name);
  swinging.draws_levels = true;
  swinging.metrics.push_back({"faded", "part of the amplitude that is lost in 10 s", 0.01, 1e-15});
  swinging.judge = [judge = swinging.judge, scene = swinging.scene](const Trial& trial) {
    constexpr int kPeriod = 63;  // ticks
    std::vector<double> errors = judge(trial);
    const auto widest = trial.largest(scene, [&](int tick, const Simulation& simulation) {
      return std::vector<double>{tick > kTicks - kPeriod ? std::abs(simulation.body(0).position.x) : 0};
    });
    errors.push_back(std::max(1 - widest[0] / kStart, 0.0));
    return errors;
  };
  return swinging;
}

// A crate of 1 kg that turns, without friction, is let go 1 m from the middle of a spring, or of a field −kx,
// while it lies on a floor; k = 0.01 … 10¹² kg a tick², undamped, 10 s. Correct: energy never grows, the
// crate stays on the floor, and what a tick resolves swings on.
std::vector<Case> makeTethers() {
  std::vector<Case> cases;
  for (const double k : {1.0, 1e2, 1e6, 1e12}) {
    cases.push_back(pulled(Pull::SPRING, k, "spring"));
    cases.push_back(pulled(Pull::FIELD, k, "field"));
  }
  cases.push_back(resolved(Pull::FIELD, "field"));
  cases.push_back(resolved(Pull::SPRING, "spring"));
  return cases;
}

const RegisteredProblem problem("30", "tethers", makeTethers, "Springs and fields where bodies touch",
                                "A spring alone is easy to solve exactly. Authors put it on a thing that "
                                "lies on the ground, and write a number that they have not computed.");

}  // namespace
}  // namespace lab
