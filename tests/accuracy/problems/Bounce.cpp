// Problem 7: a bouncing ball. Problem 15: a bounce within a tick, at 200 m/s.
#include "Path.h"

namespace lab {
namespace {

constexpr double kGravity = 10;
constexpr double kRadius = 0.5;

// Makes a ball above ground at height 0. `height` is that of the ball's lowest point.
Scene ballOverGround(double height, double restitution, int ticks) {
  Scene scene;
  Body bouncing = ball({0, height + kRadius}, {0, 0}, kRadius);
  bouncing.restitution = restitution;
  scene.bodies = {bouncing, ground(50, 0, restitution)};
  scene.gravity = {0, -kGravity};
  scene.ticks = ticks;
  return scene;
}

// Returns the height to which the ball would rise without obstacles.
double apexOf(const BodyState& state) {
  return state.position.y - kRadius + state.velocity.y * state.velocity.y / (2 * kGravity);
}

Case dying() {
  constexpr double kHeight = 10;
  constexpr double kRestitution = 0.8;
  constexpr double kSlow = 1e-3;  // m/s; a slower ball is at rest
  Case bouncing("e0.8", "restitution 0.8", ballOverGround(kHeight, kRestitution, 450));
  const double stop = std::sqrt(2 * kHeight / kGravity) * (1 + kRestitution) / (1 - kRestitution);
  bouncing.metrics = {{"first_peak", "relative error of the first peak", 1e-9, 1e-15},
                      {"third_peak", "relative error of the third peak", 1e-9, 1e-15},
                      {"stop_time_s", "error of the moment when it lies still, s", kTick, 0}};
  bouncing.judge = [scene = bouncing.scene, stop](const Trial& trial) {
    double right = kHeight;
    int bounces = 0;
    double peaks[3] = {0, 0, 0};
    double before = 0;
    int last_moving = 0;
    trial.run(scene, [&](int tick, const Simulation& simulation) {
      const BodyState state = simulation.body(0);
      if (state.velocity.y > 0 && before <= 0) {
        ++bounces;
        if (bounces <= 3) peaks[bounces - 1] = apexOf(state);
      }
      before = state.velocity.y;
      if (std::abs(state.velocity.y) > kSlow) last_moving = tick;
    });
    if (bounces < 3) throw Failure("does not bounce");
    std::vector<double> errors;
    for (const int bounce : {1, 2, 3}) {
      right *= kRestitution * kRestitution;
      if (bounce != 2) errors.push_back(std::abs(peaks[bounce - 1] / right - 1));
    }
    errors.push_back(last_moving == scene.ticks ? INFINITY : std::abs((last_moving + 1) * scene.tick - stop));
    return errors;
  };
  return bouncing;
}

Case forever() {
  constexpr double kHeight = 5;
  Case bouncing("e1", "restitution 1", ballOverGround(kHeight, 1, 3000));
  bouncing.metrics = {{"peak", "relative error of the height after 100 s", 1e-9, 1e-14}};
  bouncing.judge = atEnd(bouncing.scene,
                         [](const Simulation& end) { return std::abs(apexOf(end.body(0)) / kHeight - 1); });
  return bouncing;
}

// A ball falls from 10 m and keeps 0.8 of its speed at each bounce; another falls from 5 m and keeps all of
// it, for 100 s. Correct: peaks h e^(2k); it stops at √(2h/g) (1 + e)/(1 − e) = 12.7279 s, after infinitely
// many bounces.
std::vector<Case> makeBouncing() {
  return {dying(), forever()};
}

// A ball at 200 m/s meets a wall after 2.3 ticks and goes back with all of its speed; after 4 ticks: Right
// is: the mirrored path.
// The wall is 2.3 ticks away, so the impact is within a tick.
std::vector<Case> makeFast() {
  constexpr double kSpeed = 200;
  constexpr int kTicks = 4;
  Case bounce;
  const double gap = 2.3 * kTick * kSpeed;
  Body flying = ball({0, 0}, {kSpeed, 0}, kRadius);
  flying.restitution = 1;
  flying.fast = true;
  Body target = wall({gap + kRadius + 1, 0}, {1, 10});
  target.restitution = 1;
  bounce.scene.bodies = {flying, target};
  bounce.scene.ticks = kTicks;
  bounce.metrics = {{"end_error_m", "distance from the mirrored path, m", 1e-9, 1e-14}};
  const Vec right{2 * gap - kSpeed * bounce.scene.duration(), 0};
  bounce.judge =
      atEnd(bounce.scene, [right](const Simulation& end) { return length(end.body(0).position - right); });
  return {bounce};
}

const RegisteredProblem bouncing(
    "7", "bounce", makeBouncing, "Bouncing ball",
    "A ball that is to bounce for ever does, and one that is to stop stops when it should.");
const RegisteredProblem fast("15", "fast-bounce", makeFast, "A bounce at 200 m/s",
                             "The rest of the step after an impact is part of the motion, too.");

}  // namespace
}  // namespace lab
