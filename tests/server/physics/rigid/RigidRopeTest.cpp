// Ropes of rods: with a weight at the end, falling freely, and with mass ratios beyond double precision.
#include <gtest/gtest.h>

#include "JointScene.h"

namespace naiad::physics {
namespace {

using namespace test;

TEST(RigidRope, WeightedRopeKeepsLengthAndEnergy) {
  for (const double ratio : {1.0, 100.0, 1000.0}) {
    JointScene scene = ropeOf(20, ratio);
    const double scale = 10 * 20 * (19 + ratio), start = scene.energy(kDown);
    double drift = 0, stretch = 0;
    for (int i = 0; i < 300; ++i) {
      scene.step(kDown);
      drift = std::max(drift, std::abs(scene.energy(kDown) - start) / scale);
      stretch = std::max(stretch, scene.worstGap());
    }
    EXPECT_LE(stretch, 1e-10) << ratio;
    EXPECT_LE(drift, 1e-9) << ratio;
    EXPECT_EQ(scene.world.linkageCounters().approximate, 0) << ratio;
  }
}

TEST(RigidRope, MillionfoldWeightStaysBoundedAndIsCounted) {
  JointScene scene = ropeOf(20, 1e6);
  const double scale = 10 * 20 * 1e6, start = scene.energy(kDown);
  for (int i = 0; i < 300; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-6) << i;
    ASSERT_LE(scene.energy(kDown) - start, 1e-9 * scale) << i;
  }
  EXPECT_GT(scene.world.linkageCounters().approximate, 0);
  EXPECT_EQ(scene.world.counters().quarantined, 0);
}

// Nothing holds the rope, so that its bodies fall like a single one, however unequal they are. A blow makes
// it whirl; its momentum stays.
TEST(RigidRope, FreeRopeFallsAtG) {
  for (const double ratio : {1.0, 1e3, 1e5, 1e6}) {
    for (const double blow : {0.0, 3.0}) {
      JointScene scene = ropeOf(20, ratio, true);
      scene.setVelocity(5, {0, blow});
      const double mass = 20 + ratio;
      for (int i = 1; i <= 150; ++i) {
        scene.step(kDown);
        ASSERT_NEAR(scene.momentum().y / mass, blow / mass + 10 * kTick * i, 1e-9 * i) << ratio << " " << i;
        ASSERT_LE(scene.worstGap(), 1e-6) << ratio << " " << i;
      }
    }
  }
}

TEST(RigidRope, PullsButDoesNotPush) {
  JointScene scene = nailed();
  scene.point({0, 0.5});
  scene.join(JointKind::kRope, 0, 1, 2);
  scene.step(kDown);
  EXPECT_NEAR(scene.at(1).y, 0.5 + 5.0 / 900, 1e-12);  // it falls freely
  EXPECT_EQ(scene.force(0), Vec2{});
  for (int i = 0; i < 60; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-8);
  }
  EXPECT_NEAR(scene.at(1).y, 2, 1e-8);
  EXPECT_NEAR(scene.force(0).y, -10, 1e-5);
  scene.setVelocity(1, {0, -3});
  scene.step({0, 0});
  EXPECT_NEAR(scene.at(1).y, 1.9, 1e-8);
}

// A rope that is just taut, or slack by rounding, bends the path of its end from the first sub-step on.
TEST(RigidRope, TautRopeTurnsItsEndWhateverTheRounding) {
  const auto endAfter = [](double slack, double speed) {
    JointScene scene = nailed();
    scene.point({1, 0});
    scene.setVelocity(1, {speed, 3});
    scene.join(JointKind::kRope, 0, 1, 1 + slack);
    for (int i = 0; i < 10; ++i) scene.step(kDown);
    return scene.at(1);
  };
  const Vec2 end = endAfter(0, 0);
  for (const double slack : {-1e-12, 0.0, 1e-12}) {
    for (const double speed : {-1e-12, 0.0, 1e-12})
      EXPECT_LE(length(endAfter(slack, speed) - end), 1e-9) << slack << " " << speed;
  }
}

// A rope of rods with a single bounded joint is solved by RigidDirect instead, which must agree.
TEST(RigidRope, BothSolversKeepTheLength) {
  for (const double ratio : {1.0, 100.0}) {
    JointScene scenes[2] = {ropeOf(20, ratio), ropeOf(20, ratio)};
    scenes[1].join(JointKind::kRope, 19, 20, 1.5);
    for (int i = 0; i < 40; ++i) {
      for (JointScene& scene : scenes) {
        scene.step(kDown);
        ASSERT_LE(scene.worstGap(), 1e-6) << ratio << " " << i;
      }
    }
    EXPECT_LE(length(scenes[0].at(20) - scenes[1].at(20)), 0.05) << ratio;
    EXPECT_NE(scenes[0].at(20), scenes[1].at(20)) << "the same method twice";
  }
}

}  // namespace
}  // namespace naiad::physics
