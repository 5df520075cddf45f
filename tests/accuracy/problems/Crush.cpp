// Problem 29: thousands of bodies in one cell.
#include <cmath>
#include <string>

#include "Problem.h"
#include "shared/values/SplitMix64.h"

namespace lab {
namespace {

constexpr int kTicks = 60;
constexpr double kFastest = 0.1;  // limit of the Objects' speeds, m/s

Vec somewhere(naiad::SplitMix64& random) {
  const double x = random.unit(), y = random.unit();
  return {x, y};
}

Case crush(const std::string& name, const std::string& label, Scene scene) {
  Case crushed(name, label, std::move(scene));
  crushed.scene.ticks = kTicks;
  crushed.is_crowd = true;
  crushed.most_substeps = 4;
  crushed.metrics = {{"frozen", "bodies that froze", 0, 0, 0}};
  crushed.judge = [scene = crushed.scene](const Trial& trial) {
    return std::vector<double>{static_cast<double>(trial.run(scene)->frozen())};
  };
  return crushed;
}

Case circles(int count) {
  naiad::SplitMix64 random(29);
  Scene scene;
  for (int i = 0; i < count; ++i) scene.bodies.push_back(ball(somewhere(random), {}, 0.5));
  return crush("circles" + std::to_string(count), std::to_string(count) + " circles", std::move(scene));
}

// Circles of different sizes, so that many small ones are inside large ones.
Case sizes(int count) {
  naiad::SplitMix64 random(32);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const double radius = 0.05 + 0.45 * random.unit();
    scene.bodies.push_back(ball(somewhere(random), {}, radius, 4 * radius * radius));
  }
  return crush("sizes" + std::to_string(count), std::to_string(count) + " circles of 0.1 to 1 m",
               std::move(scene));
}

Case boxes(int count) {
  naiad::SplitMix64 random(30);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(box(somewhere(random), {0.5, 0.5}));
    scene.bodies.back().rotates = true;
  }
  return crush("boxes" + std::to_string(count), std::to_string(count) + " boxes that turn", std::move(scene));
}

// Objects without physics, each moving a little.
Case objects(int count, bool is_hard) {
  constexpr double kEach = 2;  // time limit for an Object, µs
  naiad::SplitMix64 random(31);
  Scene scene;
  scene.massless = true;
  scene.blocks = is_hard;
  scene.hearing = !is_hard;
  for (int i = 0; i < count; ++i) {
    const Vec position = somewhere(random);
    scene.bodies.push_back(point(position, kFastest * (somewhere(random) - Vec{0.5, 0.5})));
  }
  const std::string kind = is_hard ? "HARD" : "SOFT";
  Case crowd = crush("objects" + std::to_string(count) + (is_hard ? "_hard" : "_soft"),
                     std::to_string(count) + " plain Objects, " + kind, std::move(scene));
  crowd.metrics[0].fast_target = -1;  // only bodies have a fast level
  if (count == 10'000) {
    crowd.cpu_bounds = {{.name = "time_of_each",
                         .method = "",
                         .target = 1,
                         .unit_us = kEach * count,
                         .unit_label = "2 µs for each Object"}};
  }
  return crowd;
}

// 1,000 and 5,000 circles and 1,000 boxes of 1 m, and 5,000 circles of 0.1 to 1 m, whose centres lie in one
// cell, and 1,000 and 10,000 plain Objects, HARD and SOFT, that move a little in it; 60 ticks. No gravity.
// Correct: no run stops; what is asked is the time, of the first tick, too.
std::vector<Case> makeCrush() {
  return {objects(1000, true), objects(1000, false), objects(10'000, true), objects(10'000, false),
          boxes(1000),         circles(1000),        circles(5000),         sizes(5000)};
}

const RegisteredProblem problem("29", "crush", makeCrush, "Thousands in one cell",
                                "A bug of a game that makes its objects all in the same place must show as a "
                                "crowd, not as a server that hangs.");

}  // namespace
}  // namespace lab
