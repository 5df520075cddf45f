// Problem 12: friction on a slope and on a floor. Problem 13: a disc that rolls down a slope.
#include <cmath>

#include "Path.h"

namespace lab {
namespace {

constexpr double kFriction = 0.5;
constexpr double kGravity = 10;

// Makes a slope through the origin that descends to the right by `angle`, with `body` on it at the origin.
Scene onSlope(double angle, Body body, double lift, int ticks) {
  Scene scene;
  const Vec up{std::sin(angle), std::cos(angle)};
  body.position = lift * up;
  body.angle = -angle;
  body.friction = kFriction;
  body.rotates = true;
  Body slope = wall(-5 * up, {200, 5}, -angle);
  slope.friction = kFriction;
  scene.bodies = {body, slope};
  scene.gravity = {0, -kGravity};
  scene.ticks = ticks;
  return scene;
}

// Returns a judge of the way of the first body, relative to the right one.
Judge wayOf(const Scene& scene, double right) {
  return atEnd(scene, [start = scene.bodies[0].position, right](const Simulation& end) {
    return std::abs(length(end.body(0).position - start) / right - 1);
  });
}

constexpr Vec kHalf{0.5, 0.25};

Scene crateOnSlope(double angle, int ticks) {
  return onSlope(angle, box({}, kHalf), kHalf.y, ticks);
}

Case threshold() {
  constexpr int kTicks = 120;
  constexpr double kStill = 1e-5;  // m/s; on a slope 0.000013° too steep, it is exceeded after 4 s
  constexpr double kDegree = M_PI / 180;
  Case slope("", "", crateOnSlope(27 * kDegree, kTicks));
  slope.metrics = {{"threshold_deg", "error of the angle from which it slides, degrees", 1e-4, 3e-5}};
  slope.judge = [](const Trial& trial) {
    double low = 20;
    double high = 33;
    for (int i = 0; i < 20; ++i) {
      const double angle = (low + high) / 2;
      const SimulationPtr end = trial.run(crateOnSlope(angle * kDegree, kTicks));
      (length(end->body(0).velocity) > kStill ? high : low) = angle;
    }
    return std::vector<double>{std::abs((low + high) / 2 - std::atan(kFriction) / kDegree)};
  };
  return slope;
}

Case sliding() {
  constexpr double kAngle = 40 * M_PI / 180;
  Case slope("", "", crateOnSlope(kAngle, 60));
  slope.metrics = {{"sliding", "relative error of the way down a slope of 40° in 2 s", 1e-6, 1e-15}};
  const double t = slope.scene.duration();
  slope.judge = wayOf(slope.scene, kGravity * (std::sin(kAngle) - kFriction * std::cos(kAngle)) * t * t / 2);
  return slope;
}

Case stopping() {
  constexpr double kSpeed = 10;
  Case floor;
  Body crate = box({}, kHalf);
  crate.velocity = {kSpeed, 0};
  floor.scene = onSlope(0, crate, kHalf.y, 90);
  floor.metrics = {{"stop", "relative error of the way to rest from 10 m/s", 1e-6, 1e-15}};
  floor.judge = atEnd(floor.scene, [](const Simulation& end) {
    const double right = kSpeed * kSpeed / (2 * kFriction * kGravity);
    return std::abs(end.body(0).position.x / right - 1);
  });
  return floor;
}

// A crate of 1 × 0.5 m with µ = 0.5: from which angle it slides (bisection, 4 s each); how far it slides in 2
// s at 40°; how far it gets on a floor from 10 m/s. Correct: atan µ = 26.565°; g(sin θ − µ cos θ); v²/2µg.
std::vector<Case> makeFriction() {
  return {threshold(), sliding(), stopping()};
}

// A disc rolls down a slope of 30° with µ = 0.5 for 2 s. Correct: ⅔ g sin θ, without slip while tan θ < 3µ.
std::vector<Case> makeRolling() {
  constexpr double kAngle = M_PI / 6;
  constexpr double kRadius = 0.5;
  Case slope("", "", onSlope(kAngle, ball({}, {}, kRadius), kRadius, 60));
  slope.metrics = {{"way", "relative error of the way in 2 s", 1e-6, 1e-15}};
  const double t = slope.scene.duration();
  slope.judge = wayOf(slope.scene, kGravity * std::sin(kAngle) * t * t / 3);
  return {slope};
}

const RegisteredProblem friction(
    "12", "friction", makeFriction, "Friction",
    "A crate begins to slide at the angle that its friction says, and stops where it should.");
const RegisteredProblem rolling("13", "rolling", makeRolling, "Rolling disc",
                                "Wheels roll without slipping, as fast as the book says.");

}  // namespace
}  // namespace lab
