#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/bench/physics/Overlap.h"
#include "tests/bench/physics/Run.h"
#include "tests/bench/physics/Scenes.h"

namespace bench::physics {
namespace {

constexpr double kEps = 1e-12;

Body unitBox(Motion motion = Motion::DYNAMIC) {
  Body body;
  body.parts.push_back({.half_width = 0.5, .half_height = 0.5});
  body.motion = motion;
  return body;
}

Body disc(double radius) {
  Body body;
  body.parts.push_back({.radius = radius});
  return body;
}

Pose turned(double x, double y, double angle) {
  return {x, y, std::cos(angle), std::sin(angle)};
}

double depth(const Body& a, const Pose& at_a, const Body& b, const Pose& at_b) {
  const double depth = deepestOverlap({a, b}, {at_a, at_b});
  EXPECT_NEAR(deepestOverlap({b, a}, {at_b, at_a}), depth, kEps);
  return depth;
}

TEST(Overlap, UprightBoxesOverlapAlongTheShortestWayOut) {
  EXPECT_NEAR(depth(unitBox(), {0, 0}, unitBox(), {0.75, 0.25}), 0.25, kEps);
  EXPECT_NEAR(depth(unitBox(), {0, 0}, unitBox(), {-0.25, -0.875}), 0.125, kEps);
  EXPECT_EQ(depth(unitBox(), {0, 0}, unitBox(), {1, 0}), 0);
  EXPECT_EQ(depth(unitBox(), {0, 0}, unitBox(), {0.5, 1.25}), 0);
}

TEST(Overlap, RotatedBoxesAreMeasuredAlongTheirSides) {
  const double eighth = std::acos(-1.0) / 4;
  const double corner = std::sqrt(0.5);
  EXPECT_NEAR(depth(unitBox(), {0, 0}, unitBox(), turned(0.5 + corner - 0.1, 0, eighth)), 0.1, kEps);
  EXPECT_NEAR(depth(unitBox(), turned(0, 0, eighth), unitBox(), turned(0.5, 0.5, eighth)), 1 - corner, kEps);
  // The upright bounding boxes of the two overlap, but along the turned box's side there is a gap.
  for (const double x : {-0.9, 0.9}) {
    EXPECT_EQ(depth(unitBox(), {0, 0}, unitBox(), turned(x, 0.9, eighth)), 0);
    EXPECT_EQ(depth(unitBox(), {0, 0}, unitBox(), turned(x, -0.9, eighth)), 0);
  }
}

TEST(Overlap, CircleIsMeasuredFromItsEdge) {
  EXPECT_NEAR(depth(disc(1), {0, 0}, disc(0.5), {0.6, 0.8}), 0.5, kEps);
  EXPECT_EQ(depth(disc(1), {0, 0}, disc(0.5), {1.2, 0.95}), 0);
  // The circle is next to a side, at a corner, or with its centre inside.
  EXPECT_NEAR(depth(unitBox(), {0, 0}, disc(0.5), {0.2, 0.9}), 0.1, kEps);
  EXPECT_NEAR(depth(unitBox(), {0, 0}, disc(0.5), {0.74, 0.82}), 0.1, kEps);
  EXPECT_EQ(depth(unitBox(), {0, 0}, disc(0.5), {0.9, 0.9}), 0);
  EXPECT_NEAR(depth(unitBox(), {0, 0}, disc(0.5), {0.3, 0.1}), 0.7, kEps);
}

TEST(Overlap, CompoundPartsAreMeasuredButNotAgainstEachOther) {
  Body corner = unitBox();
  corner.parts = {{.half_width = 2, .half_height = 0.5, .y = 1.9},
                  {.half_width = 0.5, .half_height = 2, .x = 1.9}};
  const double quarter = std::acos(-1.0) / 2;
  EXPECT_EQ(depth(corner, {0, 0}, unitBox(), {0, 0.5}), 0);
  EXPECT_NEAR(depth(corner, {0, 0}, unitBox(), {0, 1}), 0.1, kEps);
  // A quarter turn has moved the lower part to the left.
  EXPECT_NEAR(depth(corner, turned(0, 0, quarter), unitBox(), {-1.1, 0}), 0.2, kEps);
}

TEST(Overlap, OverlapOfImmovableBodiesDoesNotCount) {
  EXPECT_EQ(depth(unitBox(Motion::STATIC), {0, 0}, unitBox(Motion::KINEMATIC), {0.5, 0}), 0);
  EXPECT_NEAR(depth(unitBox(Motion::STATIC), {0, 0}, unitBox(), {0.5, 0}), 0.5, kEps);
}

TEST(Overlap, ManyBodiesReportTheDeepestPair) {
  std::mt19937 random(7);
  const auto next = [&](double range) { return range * static_cast<double>(random()) / 4294967296.0; };
  for (int round = 0; round < 50; ++round) {
    std::vector<Body> bodies;
    std::vector<Pose> poses;
    for (int i = 0; i < 40; ++i) {
      bodies.push_back(i % 3 == 0 ? disc(0.3) : unitBox());
      poses.push_back(turned(next(20), next(20), next(7)));
    }
    bodies.front().parts.front() = {.half_width = 12, .half_height = 0.2};
    double deepest = 0;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        deepest = std::max(deepest, deepestOverlap({bodies[a], bodies[b]}, {poses[a], poses[b]}));
      }
    }
    EXPECT_GT(deepest, 0);
    EXPECT_NEAR(deepestOverlap(bodies, poses), deepest, kEps);
  }
}

TEST(WidestHinge, IsTheLargestDistanceBetweenAnchors) {
  Scene scene;
  scene.bodies = {unitBox(), unitBox()};
  scene.bodies[1].x = 1;
  scene.hinges = {{0, 1, 0.5, 0}, {Hinge::kWorld, 0, -0.5, 0}};
  EXPECT_EQ(widestHinge(scene, {{0, 0}, {1, 0}}), 0);
  EXPECT_NEAR(widestHinge(scene, {{0, 0}, {1.3, 0.4}}), 0.5, kEps);
  // The poses are those of two hanging bodies, the second one upside down below the first.
  EXPECT_NEAR(widestHinge(scene, {{-0.5, 0.5, 0, 1}, {-1, 1.25, -1, 0}}), 0.25, kEps);
  EXPECT_NEAR(widestHinge(scene, {{0, 0.7}, {1, 0.7}}), 0.7, kEps);
}

std::vector<Pose> startOf(const Scene& scene) {
  std::vector<Pose> poses;
  for (const Body& body : scene.bodies) poses.push_back({body.x, body.y});
  return poses;
}

TEST(Scenes, StartWithoutOverlap) {
  const struct {
    const char* name;
    Scene scene;
    int dynamic;
    std::size_t hinges;
  } rows[] = {{"pyramid60", makePyramid60(), 1830, 0},   {"pyramids100", makePyramids100(), 5500, 0},
              {"tumbler500", makeTumbler500(), 500, 0},  {"heap2000", makeHeap2000(), 2000, 0},
              {"heap20000", makeHeap20000(), 20'000, 0}, {"smash", makeSmash(), 2401, 0},
              {"chain100", makeChain100(), 21, 21},      {"grid100", makeGrid100(), 9993, 19'800}};
  for (const auto& [name, scene, dynamic, hinges] : rows) {
    SCOPED_TRACE(name);
    EXPECT_EQ(scene.countDynamic(), dynamic);
    EXPECT_EQ(scene.hinges.size(), hinges);
    EXPECT_EQ(widestHinge(scene, startOf(scene)), 0);
    if (scene.collide) {
      EXPECT_LT(deepestOverlap(scene.bodies, startOf(scene)), 1e-9);
    }
  }
  const std::vector<Body>& chain = rows[6].scene.bodies;
  EXPECT_DOUBLE_EQ(chain.back().mass(), 100 * chain.front().mass());
}

// Moves one body as the test specifies.
class Scripted : public Simulation {
 public:
  explicit Scripted(const Scene& scene) : poses(startOf(scene)) {}
  void tick() override { poses.back().y += fall; }
  Pose pose(std::size_t body) const override { return poses[body]; }
  bool isFrozen(std::size_t body) const override { return static_cast<int>(body) == frozen; }

  std::vector<Pose> poses;
  double fall = 0;
  int frozen = -1;
};

Scene boxOverFloor() {
  Scene scene = makePyramid60();
  scene.bodies.resize(2);
  scene.bodies.back().y = -0.5;
  scene.ticks = 25;
  return scene;
}

TEST(Run, SamplesOverlapEveryTenTicks) {
  const Scene scene = boxOverFloor();
  Scripted simulation(scene);
  simulation.fall = 0.01;
  const auto result = run(scene, simulation, 1000);
  EXPECT_EQ(result.tick_ms.size(), 25u);
  EXPECT_EQ(result.looks, 2);
  EXPECT_NEAR(result.meanOverlap(), 0.15, 1e-9);
  EXPECT_EQ(result.failed, 0);
  EXPECT_FALSE(result.cut);
  const auto stopped = run(scene, simulation, -1);  // at the time limit
  EXPECT_EQ(stopped.tick_ms.size(), 1u);
  EXPECT_TRUE(stopped.cut);
}

TEST(Run, CountsTunnelledFrozenAndNonFiniteBodies) {
  const Scene scene = boxOverFloor();
  Scripted sinking(scene), frozen(scene), lost(scene), dizzy(scene);
  sinking.fall = 0.021;  // its centre is in the floor only at the end
  frozen.frozen = 1;
  lost.fall = dizzy.poses.back().sine = std::numeric_limits<double>::quiet_NaN();
  for (Scripted* p_simulation : {&sinking, &frozen, &lost, &dizzy})
    EXPECT_EQ(run(scene, *p_simulation, 1000).failed, 1);
}

TEST(Run, ChecksTheDrumInItsRotatedFrame) {
  Scene scene = makeTumbler500();
  scene.bodies.resize(2);
  Scripted simulation(scene);
  const double eighth = std::sqrt(0.5);
  for (const auto& [pose, failed] : {std::pair{Pose{9, 9}, 1}, {Pose{9, -9}, 1}, {Pose{12, 0}, 0}}) {
    simulation.poses = {{0, 0, eighth, eighth}, pose};
    EXPECT_EQ(run(scene, simulation, 1000).failed, failed);
  }
}

}  // namespace
}  // namespace bench::physics
