// Problem 14: fast bodies against all kinds of obstacles.
#include <cmath>
#include <random>

#include "Path.h"

namespace lab {
namespace {

constexpr double kRadius = 0.25;
constexpr Vec kThin{0.1, 2};
constexpr double kSlowest = 10;   // m/s
constexpr double kFastest = 1e6;  // m/s
constexpr int kTicks = 4;
constexpr int kShots = 2000;
constexpr int kProductShots = 1000000;

enum class Pair { FIXED, KINEMATIC, DYNAMIC, FAST_FAST };

double uniform(std::mt19937_64& bits) {
  return static_cast<double>(bits() >> 11) * 0x1p-53;
}

// Makes a ball that comes from the left and an obstacle at 0, which may move towards it. They start at a
// random distance that they cover in up to two ticks.
Scene shot(Pair pair, std::mt19937_64& bits) {
  const double speed = kSlowest * std::pow(kFastest / kSlowest, uniform(bits));
  const double offset = 2 * uniform(bits) - 1;
  const double wait = 2 * uniform(bits) * kTick;
  Scene scene;
  Body target = wall({0, 0}, kThin);
  double closing = speed;
  if (pair == Pair::KINEMATIC) {
    target.motion = Motion::KINEMATIC;
    target.velocity = {-speed / 2, 0};
    closing += speed / 2;
  } else if (pair == Pair::DYNAMIC) {
    target = box({0, 0}, kThin);
  } else if (pair == Pair::FAST_FAST) {
    target = ball({0, 0}, {-speed, 0}, kRadius);
    target.fast = true;
    closing += speed;
  }
  const double reach = kRadius + (pair == Pair::FAST_FAST ? kRadius : kThin.x);
  const double aside = pair == Pair::FAST_FAST ? offset * kRadius : offset;
  Body flying = ball({-reach - closing * wait, aside}, {speed, 0}, kRadius);
  flying.fast = pair == Pair::FAST_FAST;
  flying.restitution = 1;
  target.restitution = 1;
  scene.bodies = {flying, target};
  scene.ticks = kTicks;
  return scene;
}

Case against(Pair pair, const std::string& name) {
  Case shots(name, pair == Pair::FAST_FAST ? "fast against fast" : "against " + name);
  std::mt19937_64 first(1);
  shots.scene = shot(pair, first);
  shots.metrics = {{"through", "part of the shots that go through", 0, 1e-6},
                   {"unmet", "part of the shots that never arrive", 0, 1e-6}};
  shots.judge = [pair](const Trial& trial) {
    const int count = trial.method().kind == Method::Kind::PRODUCT ? kProductShots : kShots;
    std::mt19937_64 bits(14);
    int through = 0;
    int unmet = 0;
    for (int i = 0; i < count; ++i) {
      const SimulationPtr end = trial.run(shot(pair, bits));
      if (end->body(0).position.x > end->body(1).position.x) {
        ++through;
      } else if (end->contacts() == 0) {
        ++unmet;
      }
    }
    return std::vector<double>{static_cast<double>(through) / count, static_cast<double>(unmet) / count};
  };
  return shots;
}

// A ball of radius 0.25 m is shot with 10 to 1e6 m/s (log-uniform) at a wall of 0.2 m that is static,
// kinematic and coming with half the speed, or dynamic, or at another such ball; those two are marked as
// fast, the others are not. 4 ticks, 2000 shots (the product: a million). A shot that is still before its
// target after them without a contact has been held back: it is counted as unmet. Correct: they cannot
// change sides: every shot meets its target within two ticks.
std::vector<Case> make() {
  return {against(Pair::FIXED, "static"), against(Pair::KINEMATIC, "kinematic"),
          against(Pair::DYNAMIC, "dynamic"), against(Pair::FAST_FAST, "fast_fast")};
}

const RegisteredProblem problem(
    "14", "tunnel", make, "Tunnelling",
    "A bullet must not pass through what it hits, whatever the two are and however fast.");

}  // namespace
}  // namespace lab
