// Linkages of many bodies: random trees and loops, closed systems, redundant rows, and numbers out of range.
#include <gtest/gtest.h>

#include "JointScene.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

using namespace test;

// Makes a tree of `count` bodies, free or hung on an immovable one, with random hard joints. If `is_bounded`,
// a rope that never becomes taut makes RigidDirect solve it.
JointScene randomTree(SceneRandom& random, int count, bool is_free, bool is_bounded = false) {
  JointScene scene;
  is_free ? scene.rigid({0, 0}, 1, 0.5) : scene.point({0, 0}, 0);
  for (int i = 1; i < count; ++i) {
    const int parent = random.below(i);
    const Vec2 displacement = {random.between(-1, 1), random.between(-1, 1)};
    const Vec2 place = scene.at(parent) + displacement + Vec2{0.1, 0.1};
    const double mass = random.between(0.3, 3), inertia = random.between(0.1, 1);
    const bool is_point = random() < 0.25;
    const int child = is_point ? scene.point(place, mass) : scene.rigid(place, mass, inertia);
    const Vec2 velocity = {random.between(-1, 1), random.between(-1, 1)};
    scene.setVelocity(child, velocity, is_point ? 0 : random.between(-1, 1));
    const double choice = random();
    // A body that cannot rotate resists any torque, so it has only rods at its centre.
    const bool may_turn = scene.body(child).inverse_inertia > 0 && scene.body(parent).inverse_inertia > 0;
    if (choice < 0.25 || !may_turn) {
      scene.join(JointKind::kDistance, parent, child, length(scene.at(child) - scene.at(parent)));
    } else if (choice < 0.8) {
      scene.joinAt(JointKind::kHinge, parent, child, scene.at(parent) + 0.5 * displacement);
    } else if (choice < 0.9) {
      scene.joinAt(JointKind::kWeld, parent, child, scene.at(parent) + 0.5 * displacement);
    } else {
      const Vec2 on_parent = scene.at(child) - scene.at(parent);
      scene.join(jointOf(JointKind::kSlider, parent, child, {.axis = {0.6, 0.8}}, on_parent));
    }
  }
  if (is_bounded) scene.join(JointKind::kRope, 0, count - 1, 1000);
  return scene;
}

TEST(RigidLinkage, RandomTreesKeepTheirJointsAndEnergy) {
  for (const bool is_bounded : {false, true}) {
    SceneRandom random;
    for (int round = 0; round < (is_bounded ? 10 : 40); ++round) {
      JointScene scene = randomTree(random, 2 + random.below(15), false, is_bounded);
      scene.step(kDown);
      const double start = scene.energy(kDown);
      double most = 1;
      for (int i = 0; i < 150; ++i) {
        scene.step(kDown);
        most = std::max(most, scene.kinetic());
        ASSERT_LE(scene.worstGap(), is_bounded ? 1e-4 : 1e-9) << round << " " << i;
        ASSERT_LE(std::abs(scene.energy(kDown) - start), 0.1 * most)
            << is_bounded << " " << round << " " << i;
      }
      EXPECT_EQ(scene.world.counters().quarantined, 0);
      EXPECT_EQ(scene.world.linkageCounters().approximate, 0) << round;
    }
  }
}

TEST(RigidLinkage, RandomLoopsKeepTheirJoints) {
  SceneRandom random;
  for (int round = 0; round < 30; ++round) {
    const int count = 4 + random.below(8);
    JointScene scene = nailed();
    for (int i = 1; i < count; ++i) {  // the bodies of a closed chain
      const double angle = 2 * std::acos(-1.0) * i / count;
      scene.point({2 * std::cos(angle) - 2, 2 * std::sin(angle)}, random.between(0.3, 3));
    }
    const auto rod = [&](int a, int b) {
      scene.join(JointKind::kDistance, a, b, length(scene.at(b) - scene.at(a)));
    };
    for (int i = 0; i < count; ++i) rod(i, (i + 1) % count);
    if (count > 6) rod(1, 4);  // a brace, which makes a second loop
    for (int i = 0; i < 150; ++i) {
      scene.step(kDown);
      ASSERT_LE(scene.worstGap(), 1e-9) << round << " " << i;
    }
    EXPECT_EQ(scene.world.counters().quarantined, 0);
  }
}

TEST(RigidLinkage, HundredLinkedBodiesKeepTheirMomentum) {
  SceneRandom random;
  for (const bool has_loops : {false, true}) {
    JointScene scene = randomTree(random, 100, true);
    for (int i = 0; has_loops && i < 5; ++i) {
      const int a = random.below(50), b = 50 + random.below(50);
      const double distance = length(scene.at(a) - scene.at(b));
      if (distance > 0.5) scene.join(JointKind::kDistance, a, b, distance);
    }
    for (int id = 0; id < 100; ++id) {
      const RigidBody& body = scene.body(id);
      scene.setVelocity(id, 0.1 * scene.velocity(id), body.inverse_inertia > 0 ? 0.1 * scene.spin(id) : 0);
    }
    scene.step({});
    const Vec2 start = scene.momentum();
    const double turning = scene.angularMomentum(), energy = scene.kinetic();
    double scale = 0;
    for (int id = 0; id < 100; ++id) scale += length(scene.velocity(id)) / scene.body(id).inverse_mass;
    for (int i = 0; i < 1000; ++i) scene.step({});
    EXPECT_LE(length(scene.momentum() - start), 1e-12 * scale);
    EXPECT_LE(std::abs(scene.angularMomentum() - turning), 1e-9 * scale);
    EXPECT_LE(std::abs(scene.kinetic() - energy), 1e-2 * energy);
    EXPECT_LE(scene.worstGap(), 1e-9);
    EXPECT_EQ(scene.world.linkageCounters().approximate, 0);
  }
}

TEST(RigidLinkage, RedundantRowsDoNoHarm) {
  JointScene scene = nailed();
  scene.rigid({1, 0}, 1, 0.2);
  for (int i = 0; i < 3; ++i) scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  scene.join(JointKind::kDistance, 0, 1, 1);
  const double start = scene.energy(kDown);
  for (int i = 0; i < 300; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-10);
    ASSERT_NEAR(scene.energy(kDown), start, 1e-2);
  }
  EXPECT_EQ(scene.world.linkageCounters().approximate, 0);
}

TEST(RigidLinkage, ContradictionsStayBoundedAndAreCounted) {
  JointScene scene = nailed();
  scene.point({1, 0});
  scene.point({2.5, 0}, 0);
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.join(JointKind::kDistance, 1, 2, 1);  // the rod is half a cell too short
  for (int i = 0; i < 100; ++i) {
    scene.step(kDown);
    ASSERT_LE(length(scene.at(1)), 5);
    ASSERT_LE(length(scene.velocity(1)), 100);
  }
  EXPECT_GT(scene.world.linkageCounters().approximate, 0);
}

TEST(RigidLinkage, FortyLegsOnOneBodyHold) {
  JointScene scene;
  scene.rigid({0, 0}, 5, 5);
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.157 * i;
    const int leg = scene.point({2 * std::cos(angle), 2 * std::sin(angle)}, 3);
    scene.join(jointOf(JointKind::kDistance, 0, leg, {.length = 1}, {std::cos(angle), std::sin(angle)}));
  }
  scene.setVelocity(0, {}, 1);
  scene.step({});
  const double turning = scene.angularMomentum();
  for (int i = 0; i < 100; ++i) {
    scene.step({});
    ASSERT_LE(scene.worstGap(), 1e-10);
  }
  EXPECT_NEAR(scene.angularMomentum(), turning, 1e-9);
}

TEST(RigidLinkage, ExtremeMassesAndForcesStayFinite) {
  for (const double mass : {1e-12, 1e-6, 1e6, 1e12}) {
    for (const double gravity : {1e-6, 1.0, 1e4, 1e8}) {
      JointScene scene = ropeOf(6, mass);
      for (int i = 0; i < 20; ++i) scene.step({0, gravity});
      for (int id = 0; id <= 6; ++id) {
        ASSERT_TRUE(isFinite(scene.velocity(id))) << mass << " " << gravity;
        ASSERT_LE(length(scene.at(id)), 1000) << mass << " " << gravity;
      }
    }
  }
}

// Bodies of a linkage get shapes when something may touch them, and lose them again.
TEST(RigidLinkage, ChangesOfTheGroupAreFollowed) {
  JointScene scene = ropeOf(5, 1);
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  const auto substeps = scene.world.linkageCounters().substeps;
  const int mouse = scene.join(jointOf(JointKind::kMouse, -1, 3, {.stiffness = 0.1}));
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  EXPECT_EQ(scene.world.linkageCounters().substeps, substeps);
  EXPECT_LE(scene.worstGap(), 1e-6);
  scene.world.removeJoint(mouse);
  scene.joints.pop_back();
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  EXPECT_GT(scene.world.linkageCounters().substeps, substeps);
  EXPECT_LE(scene.worstGap(), 1e-10);
  scene.world.remove(3);
  scene.joints = {0, 1, 4};
  const Vec2 before = scene.velocity(5);
  for (int i = 0; i < 10; ++i) scene.step(kDown);
  EXPECT_LE(scene.worstGap(), 1e-10);
  EXPECT_GT(length(scene.velocity(5) - before), 1);
}

TEST(RigidLinkage, StepAllocatesNothing) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  for (const bool is_bounded : {false, true}) {
    SceneRandom random;
    JointScene scene = randomTree(random, 30, false, is_bounded);
    for (int i = 0; i < 3; ++i) scene.step(kDown);
    const auto before = naiad::test::allocationsSoFar();
    for (int i = 0; i < 50; ++i) scene.world.step();
    EXPECT_EQ(naiad::test::allocationsSoFar(), before) << is_bounded;
  }
}

}  // namespace
}  // namespace naiad::physics
