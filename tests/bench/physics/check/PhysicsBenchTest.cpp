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

namespace lab {
namespace {

using bench::physics::run;

constexpr double kEps = 1e-12;

Body unitBox(Motion motion = Motion::DYNAMIC) {
  Body body = box({}, {0.5, 0.5});
  body.motion = motion;
  return body;
}

Body disc(double radius) {
  return ball({}, {}, radius);
}

BodyState turned(double x, double y, double angle) {
  return {{x, y}, {}, angle};
}

double depth(const Body& a, const BodyState& at_a, const Body& b, const BodyState& at_b) {
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
  corner.shapes = {{Shape::Kind::BOX, 0, {2, 0.5}, {0, 1.9}}, {Shape::Kind::BOX, 0, {0.5, 2}, {1.9, 0}}};
  const double quarter = std::acos(-1.0) / 2;
  EXPECT_EQ(depth(corner, {0, 0}, unitBox(), {0, 0.5}), 0);
  EXPECT_NEAR(depth(corner, {0, 0}, unitBox(), {0, 1}), 0.1, kEps);
  // A quarter turn has moved the lower part to the left.
  EXPECT_NEAR(depth(corner, turned(0, 0, quarter), unitBox(), {-1.1, 0}), 0.2, kEps);
}

TEST(Overlap, OverlapOfImmovableBodiesDoesNotCount) {
  EXPECT_EQ(depth(unitBox(Motion::FIXED), {0, 0}, unitBox(Motion::KINEMATIC), {0.5, 0}), 0);
  EXPECT_NEAR(depth(unitBox(Motion::FIXED), {0, 0}, unitBox(), {0.5, 0}), 0.5, kEps);
}

TEST(Overlap, ManyBodiesReportTheDeepestPair) {
  std::mt19937 random(7);
  const auto next = [&](double range) { return range * static_cast<double>(random()) / 4294967296.0; };
  for (int round = 0; round < 50; ++round) {
    std::vector<Body> bodies;
    std::vector<BodyState> states;
    for (int i = 0; i < 40; ++i) {
      bodies.push_back(i % 3 == 0 ? disc(0.3) : unitBox());
      states.push_back(turned(next(20), next(20), next(7)));
    }
    bodies.front().shapes = {{Shape::Kind::BOX, 0, {12, 0.2}}};
    double deepest = 0;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        deepest = std::max(deepest, deepestOverlap({bodies[a], bodies[b]}, {states[a], states[b]}));
      }
    }
    EXPECT_GT(deepest, 0);
    EXPECT_NEAR(deepestOverlap(bodies, states), deepest, kEps);
  }
}

TEST(WidestHinge, IsTheLargestDistanceBetweenAnchors) {
  Scene scene;
  scene.bodies = {unitBox(), unitBox()};
  scene.bodies[1].position.x = 1;
  scene.joints = {hinge(0, 1, {0.5, 0}), hinge(-1, 0, {-0.5, 0})};
  EXPECT_EQ(widestHinge(scene, {{0, 0}, {1, 0}}), 0);
  EXPECT_NEAR(widestHinge(scene, {{0, 0}, {1.3, 0.4}}), 0.5, kEps);
  // The states are those of two hanging bodies, the second one upside down below the first.
  const double half = std::acos(-1.0);
  EXPECT_NEAR(widestHinge(scene, {turned(-0.5, 0.5, half / 2), turned(-1, 1.25, half)}), 0.25, kEps);
  EXPECT_NEAR(widestHinge(scene, {{0, 0.7}, {1, 0.7}}), 0.7, kEps);
}

std::vector<BodyState> startOf(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back({body.position});
  return states;
}

// An Object, whose position has units of 2^-32, is exactly there.
bool isExact(const Body& wall) {
  const Vec numbers[] = {wall.position, wall.shapes.front().half};
  return std::ranges::all_of(numbers, [](Vec v) {
    return v.x * 0x1p32 == std::round(v.x * 0x1p32) && v.y * 0x1p32 == std::round(v.y * 0x1p32);
  });
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
    EXPECT_EQ(scene.joints.size(), hinges);
    EXPECT_EQ(widestHinge(scene, startOf(scene)), 0);
    if (!scene.collides) continue;  // its fixed bodies are not Objects
    EXPECT_LT(deepestOverlap(scene.bodies, startOf(scene)), 1e-9);
    for (const Body& body : scene.bodies) EXPECT_TRUE(body.motion != Motion::FIXED || isExact(body));
  }
  const std::vector<Body>& chain = rows[6].scene.bodies;
  EXPECT_DOUBLE_EQ(chain.back().mass, 100 * chain.front().mass);
}

// Moves one body as the test specifies.
class Scripted : public Simulation {
 public:
  explicit Scripted(const Scene& scene) : states(startOf(scene)) {}
  void step(double, int) override { states.back().position.y += fall; }
  BodyState body(int index) const override { return states[static_cast<std::size_t>(index)]; }
  long frozen() const override { return is_frozen ? 1 : 0; }

  std::vector<BodyState> states;
  double fall = 0;
  bool is_frozen = false;
};

Scene boxOverFloor() {
  Scene scene = makePyramid60();
  scene.bodies.resize(2);
  scene.bodies.back().position.y = -0.5;
  scene.ticks = 25;
  return scene;
}

TEST(Run, SamplesOverlapEveryTenTicks) {
  const Scene scene = boxOverFloor();
  Scripted simulation(scene);
  simulation.fall = 0.01;
  const auto result = run(scene, simulation, 1, 1000);
  EXPECT_EQ(result.tick_ms.size(), 25u);
  EXPECT_EQ(result.looks, 2);
  EXPECT_NEAR(result.meanOverlap(), 0.15, 1e-9);
  EXPECT_EQ(result.failed, 0);
  EXPECT_FALSE(result.cut);
  const auto stopped = run(scene, simulation, 1, -1);  // at the time limit
  EXPECT_EQ(stopped.tick_ms.size(), 1u);
  EXPECT_TRUE(stopped.cut);
}

TEST(Run, CountsTunnelledFrozenAndNonFiniteBodies) {
  const Scene scene = boxOverFloor();
  Scripted sinking(scene), frozen(scene), lost(scene), dizzy(scene);
  sinking.fall = 0.021;  // its centre is in the floor only at the end
  frozen.is_frozen = true;
  lost.fall = dizzy.states.back().angle = std::numeric_limits<double>::quiet_NaN();
  for (Scripted* p_simulation : {&sinking, &frozen, &lost, &dizzy})
    EXPECT_EQ(run(scene, *p_simulation, 1, 1000).failed, 1);
}

TEST(Run, ChecksTheDrumInItsRotatedFrame) {
  Scene scene = makeTumbler500();
  scene.bodies.resize(2);
  Scripted simulation(scene);
  const double eighth = std::acos(-1.0) / 4;
  for (const auto& [at, failed] : {std::pair{Vec{9, 9}, 1}, {Vec{9, -9}, 1}, {Vec{12, 0}, 0}}) {
    simulation.states = {turned(0, 0, eighth), {at}};
    EXPECT_EQ(run(scene, simulation, 1, 1000).failed, failed);
  }
}

}  // namespace
}  // namespace lab
