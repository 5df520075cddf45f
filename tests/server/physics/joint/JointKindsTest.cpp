// The properties of each kind of joint, tested with one body or two.
#include <gtest/gtest.h>

#include "JointScene.h"

namespace naiad::physics {
namespace {

using test::JointScene;
using test::kDown;
using test::kTick;

double angleAt(const JointScene& scene, int body) {
  return angleOf(scene.body(body).rotation);
}

TEST(JointKinds, WeldMakesOneBodyOfTwo) {
  JointScene scene;
  scene.rigid({0, 0}, 1, 0.2);
  scene.rigid({1, 0.5}, 3, 0.4);
  scene.joinAt(JointKind::kWeld, 0, 1, {0.5, 0});
  scene.bodies[0].velocity = {1, -2};
  scene.bodies[1].spin = 4;
  scene.connect();
  scene.step({});
  const double energy = scene.kinetic(), spin = scene.body(0).spin;
  for (int i = 0; i < 300; ++i) {
    scene.step({});
    ASSERT_LE(scene.worstGap(), 1e-10);
    ASSERT_NEAR(scene.body(0).spin, scene.body(1).spin, 1e-10);
  }
  EXPECT_NEAR(scene.kinetic(), energy, 1e-4 * energy);
  EXPECT_NEAR(scene.body(0).spin, spin, 1e-4);
}

TEST(JointKinds, SliderAllowsOneDirectionAndNoRotation) {
  JointScene scene = test::nailed();
  scene.rigid({0, 0}, 1, 1);
  Joint& slider = scene.join(JointKind::kSlider, 0, 1);
  slider.axis = {0.8, 0.6};
  scene.bodies[1].torque = 3;
  scene.connect();
  for (int i = 0; i < 60; ++i) scene.step(kDown);
  EXPECT_NEAR(length(scene.at(1)), 0.5 * 6 * 4, 1e-9);  // g · sine of the slope, as exact as in free flight
  EXPECT_LE(scene.worstGap(), 1e-10);
  EXPECT_NEAR(scene.joints[0].torque, -3, 1e-9);
  EXPECT_NEAR(dot(scene.joints[0].force, slider.axis), 0, 1e-9);
}

TEST(JointKinds, MotorReachesItsSpeedWithItsTorque) {
  JointScene scene = test::nailed();
  scene.rigid({0, 0}, 1, 2);
  scene.join(JointKind::kHinge, 0, 1);
  Joint& motor = scene.join(JointKind::kMotor, 0, 1);
  motor.speed = 5;
  motor.max_force = 4;
  scene.connect();
  for (int i = 0; i < 30; ++i) scene.step({});
  EXPECT_NEAR(scene.body(1).spin, 2, 1e-9);  // torque / inertia · time
  for (int i = 0; i < 60; ++i) scene.step({});
  EXPECT_NEAR(scene.body(1).spin, 5, 1e-9);
  EXPECT_EQ(scene.solver.counters().unsettled, 0u);
}

TEST(JointKinds, AngleLimitsStopBothWays) {
  JointScene scene = test::nailed();
  scene.rigid({1, 0}, 1, 0.1);
  scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  Joint& limit = scene.join(JointKind::kAngleLimit, 0, 1);
  limit.lower = -0.5;
  limit.upper = 0.7;
  scene.connect();
  for (int i = 0; i < 90; ++i) {
    scene.step(kDown);
    ASSERT_LE(angleAt(scene, 1), 0.7 + 1e-9);
  }
  EXPECT_NEAR(angleAt(scene, 1), 0.7, 1e-9);
  EXPECT_NEAR(scene.body(1).spin, 0, 1e-9);
  for (int i = 0; i < 90; ++i) {
    scene.step({0, -10});
    ASSERT_GE(angleAt(scene, 1), -0.5 - 1e-9);
  }
  EXPECT_NEAR(angleAt(scene, 1), -0.5, 1e-9);
  EXPECT_LE(scene.worstGap(), 1e-10);
}

TEST(JointKinds, SpringFollowsTheDampedCosine) {
  const struct {
    double stiffness, damping;
    int ticks;
    double bound;
  } kCases[] = {{4, 0, 300, 1e-5}, {25, 2, 150, 2e-3}};
  for (const auto& its : kCases) {
    JointScene scene = test::nailed();
    scene.point({3, 0});
    Joint& spring = scene.join(JointKind::kSpring, 0, 1, 2);
    spring.stiffness = its.stiffness;
    spring.damping = its.damping;
    scene.connect();
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

TEST(JointKinds, SpringEnergyStaysBoundedAtAnyStiffness) {
  for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e10}) {
    for (const double damping : {0.0, 0.1 * std::sqrt(stiffness), 10 * std::sqrt(stiffness)}) {
      for (const double rest : {0.0, 1.0}) {
        JointScene scene = test::nailed();
        scene.point({1.1, 0});
        scene.point({2.1, 0}, 0.01);
        for (int i = 0; i < 2; ++i) {
          Joint& spring = scene.join(JointKind::kSpring, i, i + 1, rest);
          spring.stiffness = stiffness;
          spring.damping = damping;
        }
        scene.connect();
        const double most = 0.5 * stiffness * (rest > 0 ? 0.01 : 1.1 * 1.1 + 1) + 4000 + 1e6 / stiffness;
        for (int i = 0; i < 300; ++i) {
          scene.step(kDown);
          ASSERT_LE(scene.kinetic(), 2 * most) << stiffness << " " << damping << " " << rest << " " << i;
        }
        EXPECT_EQ(scene.solver.counters().quarantined, 0u);
      }
    }
  }
}

TEST(JointKinds, MouseDragsWithAtMostItsForce) {
  JointScene scene;
  scene.point({0, 0}, 0.5);
  Joint& mouse = scene.join(JointKind::kMouse, -1, 0);
  mouse.target = placeAt({4, 0});
  mouse.stiffness = 100;
  mouse.damping = 30;
  mouse.max_force = 6;
  scene.connect();
  for (int i = 0; i < 15; ++i) scene.step({});
  EXPECT_NEAR(scene.body(0).velocity.x, 1.5, 1e-9);  // 3 · ½
  EXPECT_NEAR(scene.joints[0].force.x, 6, 1e-9);
  for (int i = 0; i < 300; ++i) scene.step({});
  EXPECT_NEAR(scene.at(0).x, 4, 1e-6);
  scene.joints[0].target = placeAt({4, 3});  // no call of connect() is needed
  for (int i = 0; i < 300; ++i) scene.step({});
  EXPECT_NEAR(scene.at(0).y, 3, 1e-6);
}

TEST(JointKinds, JointForceIsTheWeightAndOverloadBreaks) {
  JointScene scene = test::nailed();
  scene.point({0, 1}, 0.5);
  scene.join(JointKind::kDistance, 0, 1, 1).break_force = 25;
  scene.point({0, 2}, 1 / 0.4);
  scene.join(JointKind::kDistance, 1, 2, 1);
  scene.connect();
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.joints[0].force.y, -24, 1e-9);
  EXPECT_NEAR(scene.joints[1].force.y, -4, 1e-9);
  scene.bodies[2].force = {0, 2};
  scene.step(kDown);
  EXPECT_TRUE(scene.joints[0].is_broken);
  EXPECT_FALSE(scene.joints[1].is_broken);
  EXPECT_EQ(scene.solver.counters().broken, 1u);
  const double height = scene.at(1).y;
  scene.bodies[2].force = {};
  for (int i = 0; i < 30; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.at(1).y, height + 5, 1e-9);
  EXPECT_NEAR(scene.at(2).y - scene.at(1).y, 1, 1e-10);
}

TEST(JointKinds, MovingAnchorCarriesItsPendulum) {
  JointScene scene = test::nailed();
  scene.point({0, 1});
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.bodies[0].velocity = scene.bodies[1].velocity = {2, 0};
  scene.connect();
  for (int i = 0; i < 30; ++i) scene.step(kDown);
  EXPECT_NEAR(scene.at(0).x, 2, 1e-12);
  EXPECT_NEAR(scene.at(1).x, 2, 1e-9);
}

TEST(JointKinds, InvalidJointsBodiesAndStepsAreRefused) {
  const auto refused = [](const auto& change) {
    JointScene scene = test::nailed();
    scene.point({1, 0});
    scene.join(JointKind::kDistance, 0, 1, 1);
    change(scene);
    return scene.connect() == -1;
  };
  const double nan = std::nan("");
  EXPECT_FALSE(refused([](JointScene&) {}));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].b = 2; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].a = -1; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].b = 0; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].length = 0; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].length = 1e31; }));
  EXPECT_TRUE(refused([&](JointScene& s) { s.joints[0].length = nan; }));
  EXPECT_TRUE(refused([&](JointScene& s) { s.joints[0].anchor_a.x = nan; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.joints[0].stiffness = -1; }));
  EXPECT_TRUE(refused([&](JointScene& s) { s.bodies[1].velocity.y = nan; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.bodies[1].inverse_mass = -1; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.bodies[1].inverse_mass = kNoLimit; }));
  EXPECT_TRUE(refused([](JointScene& s) { s.bodies[1].rotation = {0, 0}; }));
  JointScene scene = test::ropeOf(2, 1);
  EXPECT_EQ(scene.step(kDown, {}, 0), -1);
  EXPECT_EQ(scene.step(kDown, {}, nan), -1);
  EXPECT_EQ(scene.step({nan, 0}), -1);
  EXPECT_EQ(scene.step(kDown, {JointMethod::kRattle, 0}), -1);
  scene.point({5, 5});
  EXPECT_EQ(scene.step(kDown), -1);  // connect() was not called again after the new body
}

}  // namespace
}  // namespace naiad::physics
