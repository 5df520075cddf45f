// Ropes of rods: with a weight at the end, at rest, and with mass ratios beyond double precision.
#include <gtest/gtest.h>

#include "JointScene.h"

namespace naiad::physics {
namespace {

using test::JointScene;
using test::kDown;
using test::ropeOf;

TEST(JointRope, WeightedRopeKeepsLengthAndEnergy) {
  for (const double ratio : {1.0, 100.0, 1000.0}) {
    JointScene scene = ropeOf(20, ratio);
    EXPECT_EQ(scene.solver.islands()[0].fill(), 0);
    const double scale = 10 * 20 * (19 + ratio), start = scene.energy(kDown);
    double drift = 0, stretch = 0;
    for (int i = 0; i < 300; ++i) {
      scene.step(kDown);
      drift = std::max(drift, std::abs(scene.energy(kDown) - start) / scale);
      stretch = std::max(stretch, scene.worstGap());
    }
    EXPECT_LE(stretch, 1e-10) << ratio;
    EXPECT_LE(drift, 2e-2) << ratio;
    EXPECT_EQ(scene.solver.counters().regularised, 0u) << ratio;
    EXPECT_EQ(scene.solver.counters().dependent, 0u) << ratio;
  }
}

TEST(JointRope, MillionfoldWeightStaysBoundedAndCountsFallbacks) {
  JointScene scene = ropeOf(20, 1e6);
  const double scale = 10 * 20 * 1e6, start = scene.energy(kDown);
  for (int i = 0; i < 300; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-6) << i;
    ASSERT_LE(scene.energy(kDown) - start, 0.1 * scale) << i;
    ASSERT_LE(length(scene.at(20)), 20 + 1e-6);
  }
  EXPECT_GT(scene.solver.counters().regularised, 0u);
  EXPECT_EQ(scene.solver.counters().quarantined, 0u);
}

// Rods in a line have their own method, which must agree with the general one. A post that rotates selects
// the general method, without another effect on its rods.
TEST(JointRope, ChainAndGeneralMethodsAgree) {
  for (const bool is_bridge : {false, true}) {
    JointScene scenes[2];
    for (const bool is_general : {false, true}) {
      JointScene& scene = scenes[is_general ? 1 : 0];
      for (int i = 0; i <= 10; ++i) {
        scene.point({0.6 * i, is_bridge ? 0.8 * (i % 2) : 0.8 * i},
                    i == 0 || (is_bridge && i == 10) ? 0 : 1.0 / (1 + i % 3));
      }
      scene.bodies[0].spin = is_general ? 1 : 0;
      for (const int i : {4, 0, 9, 3, 1, 8, 2, 7, 5, 6}) {  // order and directions are mixed
        scene.join(JointKind::kDistance, i % 2 == 0 ? i : i + 1, i % 2 == 0 ? i + 1 : i, 1);
      }
      scene.connect();
      ASSERT_EQ(scene.solver.islands().size(), 1u);
      for (int i = 0; i < 20; ++i) scene.step(kDown);
      ASSERT_GT(scene.kinetic(), 0.1);
    }
    for (int i = 0; i <= 10; ++i) {
      EXPECT_LE(length(scenes[0].at(i) - scenes[1].at(i)), 1e-9) << is_bridge << " " << i;
      EXPECT_LE(length(scenes[0].body(i).velocity - scenes[1].body(i).velocity), 1e-8)
          << is_bridge << " " << i;
    }
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_LE(length(scenes[0].joints[i].force - scenes[1].joints[i].force), 1e-6) << is_bridge << " " << i;
    }
    EXPECT_NE(scenes[0].at(5), scenes[1].at(5)) << "the same method twice";
  }
}

// Returns the sag of a chain between two points, at rest after some drag, for comparison with a·cosh(x/a).
double sagOf(int links) {
  const double span = 10, total = 12;
  JointScene scene = test::nailed();
  for (int i = 1; i < links; ++i) {  // at the start, the chain is two sides of a triangle of this length
    const double s = static_cast<double>(i) / links;
    const double depth = std::sqrt(0.25 * (total * total - span * span));
    scene.point({span * s, depth * (1 - std::abs(1 - 2 * s))}, links / total);
  }
  scene.point({span, 0}, 0);
  for (int i = 0; i < links; ++i) scene.join(JointKind::kDistance, i, i + 1, total / links);
  scene.connect();
  for (int i = 0; i < 3000; ++i) {
    for (JointBody& body : scene.bodies) body.velocity *= 0.9;
    scene.step(kDown);
  }
  EXPECT_LE(scene.worstGap(), 1e-10);
  EXPECT_LE(std::sqrt(scene.kinetic()), 1e-6);
  return scene.at(links / 2).y;
}

TEST(JointRope, HangsAsACatenary) {
  const double half = 5, total = 12;
  double low = 0.1, high = 1000;  // range of a; the chain's length decreases as a grows
  for (int i = 0; i < 200; ++i) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(half / a) > total ? low : high) = a;
  }
  const double sag = low * (std::cosh(half / low) - 1);
  const double coarse = std::abs(sagOf(20) / sag - 1), fine = std::abs(sagOf(40) / sag - 1);
  EXPECT_LE(coarse, 1e-2);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);  // the error is of order 2, because the links are straight
}

TEST(JointRope, PullsButDoesNotPush) {
  JointScene scene = test::nailed();
  scene.point({0, 0.5});
  scene.join(JointKind::kRope, 0, 1, 2);
  scene.connect();
  scene.step(kDown);
  EXPECT_NEAR(scene.at(1).y, 0.5 + 5.0 / 900, 1e-12);  // it falls freely
  EXPECT_EQ(scene.joints[0].force, Vec2{});
  for (int i = 0; i < 60; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-10);
  }
  EXPECT_NEAR(scene.at(1).y, 2, 1e-9);
  EXPECT_NEAR(scene.joints[0].force.y, -10, 1e-6);
  scene.bodies[1].velocity = {0, -3};
  scene.step({0, 0});
  EXPECT_NEAR(scene.at(1).y, 1.9, 1e-9);
}

TEST(JointRope, BehavesTheSameFarAway) {
  JointScene here = ropeOf(8, 10), there = ropeOf(8, 10);
  for (JointBody& body : there.bodies) {
    body.place.cell_x += 1'000'000'000;
    body.place.cell_y -= 1'000'000'000;
  }
  for (int i = 0; i < 200; ++i) {
    here.step(kDown);
    there.step(kDown);
  }
  for (std::size_t i = 0; i < here.bodies.size(); ++i) {
    EXPECT_EQ(here.bodies[i].velocity, there.bodies[i].velocity);
    EXPECT_EQ(here.bodies[i].place.dx, there.bodies[i].place.dx);
    EXPECT_EQ(here.bodies[i].place.dy, there.bodies[i].place.dy);
    EXPECT_EQ(here.bodies[i].place.cell_x + 1'000'000'000, there.bodies[i].place.cell_x);
  }
}

}  // namespace
}  // namespace naiad::physics
