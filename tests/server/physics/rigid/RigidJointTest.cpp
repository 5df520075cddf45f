// The properties of each kind of joint, tested with one body or two.
#include <gtest/gtest.h>

#include "JointScene.h"

namespace naiad::physics {
namespace {

using namespace test;

TEST(RigidJoint, WeldMakesOneBodyOfTwo) {
  JointScene scene;
  scene.rigid({0, 0}, 1, 0.2);
  scene.rigid({1, 0.5}, 3, 0.4);
  scene.joinAt(JointKind::kWeld, 0, 1, {0.5, 0});
  scene.setVelocity(0, {1, -2});
  scene.setVelocity(1, {0, 0}, 4);
  scene.step({});
  const double energy = scene.kinetic(), spin = scene.spin(0);
  for (int i = 0; i < 300; ++i) {
    scene.step({});
    ASSERT_LE(scene.worstGap(), 1e-10);
    ASSERT_NEAR(scene.spin(0), scene.spin(1), 1e-9);
  }
  EXPECT_NEAR(scene.kinetic(), energy, 1e-4 * energy);
  EXPECT_NEAR(scene.spin(0), spin, 1e-4);
}

TEST(RigidJoint, SliderAllowsOneDirectionAndNoRotation) {
  JointScene scene = nailed();
  scene.rigid({0, 0}, 1, 1);
  const Joint slider = jointOf(JointKind::kSlider, 0, 1, {.axis = {0.8, 0.6}});
  scene.join(slider);
  for (int i = 0; i < 60; ++i) {
    scene.change(1).torque = 3 * kTick * kTick;
    scene.apply();
    scene.step(kDown);
  }
  EXPECT_NEAR(length(scene.at(1)), 0.5 * 6 * 4, 1e-9);  // g · sine of the slope, as exact as in free flight
  EXPECT_LE(scene.worstGap(), 1e-10);
  EXPECT_NEAR(scene.torque(0), -3, 1e-9);
  EXPECT_NEAR(dot(scene.force(0), slider.axis), 0, 1e-9);
}

TEST(RigidJoint, MotorReachesItsSpeedWithItsTorque) {
  JointScene scene = nailed();
  scene.rigid({0, 0}, 1, 2);
  scene.join(JointKind::kHinge, 0, 1);
  scene.join(jointOf(JointKind::kMotor, 0, 1, {.speed = 5 * kTick, .max_force = 4 * kTick * kTick}));
  for (int i = 0; i < 30; ++i) scene.step({});
  EXPECT_NEAR(scene.spin(1), 2, 1e-9);  // torque / inertia · time
  for (int i = 0; i < 60; ++i) scene.step({});
  EXPECT_NEAR(scene.spin(1), 5, 1e-9);
}

TEST(RigidJoint, AngleLimitsStopBothWays) {
  JointScene scene = nailed();
  scene.rigid({1, 0}, 1, 0.1);
  scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  scene.join(jointOf(JointKind::kAngleLimit, 0, 1, {.lower = -0.5, .upper = 0.7}));
  for (int i = 0; i < 90; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.angle(1), 0.7 + 1e-9);
  }
  EXPECT_NEAR(scene.angle(1), 0.7, 1e-9);
  EXPECT_NEAR(scene.spin(1), 0, 1e-8);
  for (int i = 0; i < 90; ++i) {
    scene.step({0, -10});
    ASSERT_GE(scene.angle(1), -0.5 - 1e-9);
  }
  EXPECT_NEAR(scene.angle(1), -0.5, 1e-9);
  EXPECT_LE(scene.worstGap(), 1e-9);
}

TEST(RigidJoint, SpringFollowsTheDampedCosine) {
  const struct {
    double stiffness, damping;
    int ticks;
    double bound;
  } kCases[] = {{4, 0, 300, 1e-3}, {25, 2, 150, 2e-3}};
  for (const auto& its : kCases) {
    JointScene scene = nailed();
    scene.point({3, 0});
    const double stiffness = its.stiffness * kTick * kTick, damping = its.damping * kTick;
    scene.join(jointOf(JointKind::kSpring, 0, 1, {.length = 2, .stiffness = stiffness, .damping = damping}));
    const double decay = its.damping / 2, w = std::sqrt(its.stiffness - decay * decay);
    double worst = 0;
    for (int i = 1; i <= its.ticks; ++i) {
      scene.step({});
      const double t = i * kTick;
      const double exact = 2 + std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
      worst = std::max(worst, std::abs(scene.at(1).x - exact));
    }
    EXPECT_LE(worst, its.bound) << its.damping;
  }
}

TEST(RigidJoint, SpringEnergyStaysBoundedAtAnyStiffness) {
  for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e10}) {
    for (const double damping : {0.0, 0.1 * std::sqrt(stiffness), 10 * std::sqrt(stiffness)}) {
      for (const double rest : {0.0, 1.0}) {
        JointScene scene = nailed();
        scene.point({1.1, 0});
        scene.point({2.1, 0}, 0.01);
        for (int i = 0; i < 2; ++i) {
          const double k = stiffness * kTick * kTick;
          scene.join(jointOf(JointKind::kSpring, i, i + 1,
                             {.length = rest, .stiffness = k, .damping = damping * kTick}));
        }
        const double most = 0.5 * stiffness * (rest > 0 ? 0.01 : 1.1 * 1.1 + 1) + 4000 + 1e6 / stiffness;
        for (int i = 0; i < 300; ++i) {
          scene.step(kDown);
          ASSERT_LE(scene.kinetic(), 2 * most) << stiffness << " " << damping << " " << rest << " " << i;
        }
        EXPECT_EQ(scene.world.counters().quarantined, 0);
      }
    }
  }
}

TEST(RigidJoint, MouseDragsWithAtMostItsForce) {
  JointScene scene;
  scene.point({0, 0}, 0.5);
  const double stiffness = 100 * kTick * kTick, damping = 30 * kTick, force = 6 * kTick * kTick;
  Joint mouse =
      jointOf(JointKind::kMouse, -1, 0, {.stiffness = stiffness, .damping = damping, .max_force = force});
  mouse.target = placeAt({4, 0});
  const int id = scene.join(mouse);
  for (int i = 0; i < 15; ++i) scene.step({});
  EXPECT_NEAR(scene.velocity(0).x, 1.5, 1e-9);  // 3 · ½
  EXPECT_NEAR(scene.force(id).x, 6, 1e-9);
  for (int i = 0; i < 300; ++i) scene.step({});
  EXPECT_NEAR(scene.at(0).x, 4, 1e-6);
  mouse.target = placeAt({4, 3});
  EXPECT_TRUE(scene.world.setJoint(id, mouse));
  for (int i = 0; i < 300; ++i) scene.step({});
  EXPECT_NEAR(scene.at(0).y, 3, 1e-6);
}

TEST(RigidJoint, JointForceIsTheWeightAndOverloadBreaks) {
  JointScene scene = nailed();
  scene.point({0, 1}, 0.5);
  scene.join(jointOf(JointKind::kDistance, 0, 1, {.length = 1, .break_force = 25 * kTick * kTick}));
  scene.point({0, 2}, 1 / 0.4);
  scene.join(JointKind::kDistance, 1, 2, 1);
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.force(0).y, -24, 1e-9);
  EXPECT_NEAR(scene.force(1).y, -4, 1e-9);
  scene.change(2).acceleration += Vec2{0, 2 / 0.4 * kTick * kTick};
  scene.apply();
  scene.world.step();
  EXPECT_TRUE(scene.world.joint(0).is_broken);
  EXPECT_FALSE(scene.world.joint(1).is_broken);
  EXPECT_EQ(scene.world.counters().broken, 1);
  const double height = scene.at(1).y;
  for (int i = 0; i < 30; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.at(1).y, height + 5, 1e-9);
  EXPECT_NEAR(scene.at(2).y - scene.at(1).y, 1, 1e-10);
}

TEST(RigidJoint, MovingAnchorCarriesItsPendulum) {
  JointScene scene = nailed();
  scene.point({0, 1});
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.setVelocity(0, {2, 0});
  scene.setVelocity(1, {2, 0});
  for (int i = 0; i < 30; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.at(0).x, 2, 1e-12);
  EXPECT_NEAR(scene.at(1).x, 2, 1e-9);
}

TEST(RigidJoint, InvalidJointsAreRefused) {
  const auto refused = [](const auto& change) {
    JointScene scene = nailed();
    scene.point({1, 0});
    Joint joint = jointOf(JointKind::kDistance, 0, 1, {.length = 1});
    change(joint);
    return scene.join(joint) == -1;
  };
  const double nan = std::nan("");
  EXPECT_FALSE(refused([](Joint&) {}));
  EXPECT_TRUE(refused([](Joint& joint) { joint.b = 2; }));
  EXPECT_TRUE(refused([](Joint& joint) { joint.a = -1; }));
  EXPECT_TRUE(refused([](Joint& joint) { joint.b = 0; }));
  EXPECT_TRUE(refused([](Joint& joint) { joint.length = 0; }));
  EXPECT_TRUE(refused([](Joint& joint) { joint.length = 1e31; }));
  EXPECT_TRUE(refused([&](Joint& joint) { joint.length = nan; }));
  EXPECT_TRUE(refused([&](Joint& joint) { joint.anchor_a.x = nan; }));
  EXPECT_TRUE(refused([](Joint& joint) { joint.stiffness = -1; }));
}

}  // namespace
}  // namespace naiad::physics
