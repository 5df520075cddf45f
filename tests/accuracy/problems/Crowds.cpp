// Problem 24: bodies that receive collision events but push nothing. Problem 29: thousands of bodies in one
// cell.
#include <cmath>
#include <string>
#include <vector>

#include "Path.h"
#include "shared/values/SplitMix64.h"

namespace lab {
namespace {

constexpr double kRadius = 0.5;
constexpr int kTicks = 60;

Vec somewhere(naiad::SplitMix64& random) {
  const double x = random.unit(), y = random.unit();
  return {x, y};
}

// Measures the difference between the numbers of pairs with an event and of pairs that overlap, relative to
// the latter.
Case hearing(const std::string& name, Scene scene, long pairs) {
  Case heard(name, "", std::move(scene));
  heard.scene.hearing = true;
  heard.scene.ticks = kTicks;
  heard.most_substeps = 4;
  heard.metrics = {{"misheard", "pairs that are heard of wrongly, of all", 0, 1e-6}};
  heard.judge = atEnd(heard.scene, [pairs](const Simulation& end) {
    const auto all = static_cast<double>(pairs > 0 ? pairs : 1);
    return std::abs(static_cast<double>(end.contacts() - pairs)) / all;
  });
  return heard;
}

Scene grid(int side) {
  constexpr double kApart = 3;  // distance of neighbours, m
  Scene scene;
  for (int i = 0; i < side * side; ++i) {
    scene.bodies.push_back(ball({kApart * (i % side), kApart * (i / side)}, {}, kRadius));
  }
  return scene;
}

// The bodies are those of the case "apart", but HARD. Its time is the reference for that case's.
Case hardApart(int side) {
  Case hard = hearing("hard" + std::to_string(side * side), grid(side), 0);
  hard.label = std::to_string(side * side) + " apart, HARD";
  hard.scene.hearing = false;
  hard.judge = atEnd(hard.scene, [](const Simulation& end) { return static_cast<double>(end.contacts()); });
  return hard;
}

Case apart(int side) {
  Case soft = hearing("apart" + std::to_string(side * side), grid(side), 0);
  soft.label = std::to_string(side * side) + " apart";
  soft.cpu_bounds = {{.name = "cpu_ratio",
                      .method = "",
                      .target = 1.5,
                      .of_case = "hard" + std::to_string(side * side),
                      .unit_label = "the same bodies, HARD"}};
  return soft;
}

// All bodies overlap each other.
Case together(int count) {
  naiad::SplitMix64 random(24);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(ball(kRadius * somewhere(random), {}, kRadius));
  }
  constexpr double kPair = 0.1;  // time limit for a pair, µs
  const long pairs = static_cast<long>(count) * (count - 1) / 2;
  Case soft = hearing("together" + std::to_string(count), scene, pairs);
  soft.label = std::to_string(count) + " together";
  soft.cpu_bounds = {{.name = "time_of_pairs",
                      .method = "",
                      .target = 1,
                      .unit_us = kPair * static_cast<double>(pairs),
                      .unit_label = "100 ns a pair"}};
  return soft;
}

// SOFT bodies, which nothing pushes, for 60 ticks: 1,024 circles of 1 m that are 3 m apart, and 50, 100, 200
// and 400 circles that all overlap each other. The time is compared with that of equal HARD bodies, and with
// 100 ns per pair. Only for the product. Correct: each overlapping pair has one event, in the first tick,
// which is the slowest.
std::vector<Case> makeCrowds() {
  return {hardApart(32), apart(32), together(50), together(100), together(200), together(400)};
}

Case crush(const std::string& name, const std::string& label, Scene scene) {
  Case crushed(name, label, std::move(scene));
  crushed.scene.ticks = kTicks;
  crushed.is_crowd = true;
  crushed.most_substeps = 4;
  crushed.metrics = {{"frozen", "bodies that froze", 0, 0, 0}};
  crushed.judge =
      atEnd(crushed.scene, [](const Simulation& end) { return static_cast<double>(end.frozen()); });
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
  constexpr double kFastest = 0.1;  // limit of the Objects' speeds, m/s
  constexpr double kEach = 2;       // time limit for an Object, µs
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

const RegisteredProblem crowds(
    "24", "crowds", makeCrowds, "Crowds that hear",
    "Sensors, clouds and triggers lie in one another by hundreds, and must not cost a tick.");
const RegisteredProblem crush_problem(
    "29", "crush", makeCrush, "Thousands in one cell",
    "A bug of a game that makes its objects all in the same place must show as a "
    "crowd, not as a server that hangs.");

}  // namespace
}  // namespace lab
