// Problem 8: Newton's cradle. 8b: oblique elastic billiard. 8c: Galperin's billiard, which counts the digits
// of π.
#include <algorithm>
#include <cmath>

#include "Path.h"

namespace lab {
namespace {

constexpr int kBalls = 5;
constexpr double kRadius = 0.5;
constexpr double kSpeed = 5;

Body elasticBall(Vec position, Vec velocity, double mass = 1) {
  Body body = ball(position, velocity, kRadius, mass);
  body.restitution = 1;
  return body;
}

Case freeCradle() {
  Case cradle("free", "free balls");
  for (int i = 0; i < kBalls; ++i) {
    const double gap = i == 0 ? 1 : 0;
    cradle.scene.bodies.push_back(elasticBall({i * 2 * kRadius - gap, 0}, {i == 0 ? kSpeed : 0, 0}));
  }
  cradle.scene.ticks = 30;
  cradle.metrics = {{"velocity", "largest error of a velocity, of the first ball's", 1e-9, 1e-16}};
  cradle.judge = atEnd(cradle.scene, [](const Simulation& end) {
    double worst = 0;
    for (int i = 0; i < kBalls; ++i) {
      const Vec right{i == kBalls - 1 ? kSpeed : 0, 0};
      worst = std::max(worst, length(end.body(i).velocity - right) / kSpeed);
    }
    return worst;
  });
  return cradle;
}

// A cradle on rods of 5 m, whose first ball is released at 30°. After the impact the last ball must have the
// first one's speed, and all others none. Speeds are computed from energies.
Case hungCradle() {
  constexpr double kRod = 5;
  constexpr double kGravity = 10;
  constexpr double kAngle = M_PI / 6;
  Case cradle("hung", "hung on rods");
  for (int i = 0; i < kBalls; ++i) {
    const Vec pivot{i * 2 * kRadius, kRod};
    const double angle = i == 0 ? -kAngle : 0;
    cradle.scene.bodies.push_back(
        elasticBall(pivot + Vec{kRod * std::sin(angle), -kRod * std::cos(angle)}, {0, 0}));
    cradle.scene.joints.push_back(rod(-1, pivot, i, cradle.scene.bodies.back().position));
  }
  cradle.scene.gravity = {0, -kGravity};
  cradle.scene.ticks = 45;  // the first ball hits the second after 1.13 s
  cradle.metrics = {{"velocity", "largest error of a speed, of the first ball's at the impact", 1e-3, 1e-15}};
  cradle.judge = atEnd(cradle.scene, [](const Simulation& end) {
    const double energy = kGravity * kRod * (1 - std::cos(kAngle));
    double worst = 0;
    for (int i = 0; i < kBalls; ++i) {
      const BodyState state = end.body(i);
      const double its_energy = dot(state.velocity, state.velocity) / 2 + kGravity * state.position.y;
      const double speed = std::sqrt(std::max(0.0, its_energy / energy));
      worst = std::max(worst, std::abs(speed - (i == kBalls - 1 ? 1 : 0)));
    }
    return worst;
  });
  return cradle;
}

// Five equal balls touch each other on a line; the first comes with 5 m/s. Then such balls hung on rods of 5
// m, the first let go at 30°. Correct: 0, 0, 0, 0, v: impacts one after another, the nearest first.
std::vector<Case> makeCradle() {
  return {freeCradle(), hungCradle()};
}

// Shoots balls at resting balls with different offsets. The pairs are too far apart to affect each other.
Case billiard(double speed) {
  constexpr int kPairs = 24;
  constexpr double kApart = 32;
  constexpr double kWay = 1.5;  // m, from the start to about the impact
  Case shots("v" + std::to_string(std::lround(speed)), std::to_string(std::lround(speed)) + " m/s");
  std::vector<Vec> right;
  for (int i = 0; i < kPairs; ++i) {
    const double offset = (i + 0.5) / kPairs * 2 * kRadius * 0.98;
    const double y = kApart * (i - kPairs / 2);
    Body shot = elasticBall({0, y + offset}, {speed, 0});
    shot.fast = true;
    shots.scene.bodies.push_back(shot);
    shots.scene.bodies.push_back(elasticBall({kWay + 2 * kRadius, y}, {0, 0}));
    // There is no friction, and masses are equal, so the struck ball gets the velocity along the line of
    // centres.
    const Vec normal{std::sqrt(4 * kRadius * kRadius - offset * offset), -offset};
    right.push_back(dot(normal, {speed, 0}) / dot(normal, normal) * normal);
  }
  shots.scene.ticks = static_cast<int>(std::ceil((kWay + 2 * kRadius + 0.1) / speed / kTick)) + 2;
  shots.metrics = {{"struck_mean", "mean error of the struck ball's velocity, of the shot's", 1e-9, 1e-16},
                   {"struck_max", "largest error of the struck ball's velocity, of the shot's", 1e-9, 1e-16}};
  shots.judge = [scene = shots.scene, right, speed](const Trial& trial) {
    const SimulationPtr end = trial.run(scene);
    double sum = 0;
    double worst = 0;
    for (std::size_t i = 0; i < right.size(); ++i) {
      const double error = length(end->body(static_cast<int>(2 * i + 1)).velocity - right[i]) / speed;
      sum += error;
      worst = std::max(worst, error);
    }
    return std::vector<double>{sum / static_cast<double>(right.size()), worst};
  };
  return shots;
}

// A ball of radius 0.5 m hits an equal one that rests, at 24 offsets from the centre to the edge; no
// friction. Correct: the geometry of the impact: the struck ball leaves along the line of centres.
std::vector<Case> makeBilliard() {
  return {billiard(5), billiard(50)};
}

// A box of 100^k kg pushes a box of 1 kg towards a wall without loss of energy, so that the light box moves
// back and forth between the heavy one and the wall. All collisions in 10 s are counted, including those with
// the wall. Correct: ⌈π / atan √(1/M)⌉ − 1 = 3, 31, 314, 3141, 31415, where M = 100^k.
std::vector<Case> makeGalperin() {
  std::vector<Case> cases;
  constexpr int kTicks = 300;
  constexpr double kHalf = 0.1;
  int right = 3;
  double mass = 1;
  for (int k = 0; k <= 4; ++k, mass *= 100, right = static_cast<int>(M_PI * std::pow(10, k))) {
    Case shove("k" + std::to_string(k), "mass ratio 100^" + std::to_string(k));
    Body stop = wall({-1, 0}, {1, 1});
    Body light = box({1 + kHalf, 0}, {kHalf, kHalf});
    Body heavy = box({2 + 3 * kHalf, 0}, {kHalf, kHalf}, mass);
    heavy.velocity = {-1, 0};
    shove.scene.bodies = {stop, light, heavy};
    for (Body& body : shove.scene.bodies) {
      body.restitution = 1;
      body.fast = body.motion == Motion::DYNAMIC;
    }
    shove.scene.ticks = kTicks;
    shove.metrics = {{"count", "error of the number of collisions, of " + std::to_string(right), 0, 0}};
    shove.judge = atEnd(shove.scene, [right](const Simulation& end) {
      if (end.contacts() < 0) throw Inexpressible();
      return std::abs(static_cast<double>(end.contacts()) / right - 1);
    });
    cases.push_back(shove);
  }
  return cases;
}

const RegisteredProblem cradle(
    "8", "cradle", makeCradle, "Newton's cradle",
    "Impacts at the same moment have an order, and a solver that averages them gets every ball moving.");
const RegisteredProblem oblique(
    "8b", "billiard", makeBilliard, "Oblique elastic billiard",
    "Where a ball goes after an impact depends on the exact point of contact: pool games live on it.");
const RegisteredProblem galperin(
    "8c", "galperin", makeGalperin, "Galperin's billiard",
    "An exact count of impacts, up to 15,678 of them in one tick, shows that none is lost or made up.");

}  // namespace
}  // namespace lab
