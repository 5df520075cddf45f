#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "tests/bench/physics/Overlap.h"

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

}  // namespace
}  // namespace bench::physics
