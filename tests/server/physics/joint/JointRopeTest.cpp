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

}  // namespace
}  // namespace naiad::physics
