// Systems of many bodies: random trees and loops, closed systems, redundant rows, and numbers out of range.
#include <gtest/gtest.h>

#include "JointScene.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

using test::JointScene;
using test::kDown;
using test::SceneRandom;

// Makes a tree of `count` bodies, free or hung on an immovable one, with random hard joints.
JointScene randomTree(SceneRandom& random, int count, bool is_free) {
  JointScene scene;
  is_free ? scene.rigid({0, 0}, 1, 0.5) : scene.point({0, 0}, 0);
  for (int i = 1; i < count; ++i) {
    const int parent = random.below(i);
    const Vec2 displacement = {random.between(-1, 1), random.between(-1, 1)};
    const Vec2 place = scene.at(parent) + displacement + Vec2{0.1, 0.1};
    const double mass = random.between(0.3, 3), inertia = random.between(0.1, 1);
    const int child = random() < 0.25 ? scene.point(place, mass) : scene.rigid(place, mass, inertia);
    scene.bodies.back().velocity = {random.between(-1, 1), random.between(-1, 1)};
    if (scene.body(child).inverse_inertia > 0) scene.bodies.back().spin = random.between(-1, 1);
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
      scene.join(JointKind::kSlider, parent, child).axis = {0.6, 0.8};
      scene.joints.back().anchor_a = scene.at(child) - scene.at(parent);
    }
  }
  return scene;
}

TEST(JointSystem, RandomTreesKeepTheirJointsAndEnergy) {
  SceneRandom random;
  for (int round = 0; round < 40; ++round) {
    JointScene scene = randomTree(random, 2 + random.below(15), false);
    ASSERT_EQ(scene.connect(), 0);
    for (const JointIsland& island : scene.solver.islands()) EXPECT_EQ(island.fill(), 0);
    scene.step(kDown);
    const double start = scene.energy(kDown);
    double most = 1;
    for (int i = 0; i < 150; ++i) {
      scene.step(kDown);
      most = std::max(most, scene.kinetic());
      ASSERT_LE(scene.worstGap(), 1e-10) << round << " " << i;
      ASSERT_LE(std::abs(scene.energy(kDown) - start), 0.1 * most) << round << " " << i;
    }
    EXPECT_EQ(scene.solver.counters().quarantined, 0u);
    EXPECT_EQ(scene.solver.counters().regularised, 0u) << round;
  }
}

TEST(JointSystem, RandomLoopsKeepTheirJoints) {
  SceneRandom random;
  for (int round = 0; round < 30; ++round) {
    const int count = 4 + random.below(8);
    JointScene scene = test::nailed();
    for (int i = 1; i < count; ++i) {  // the bodies of a closed chain
      const double angle = 2 * std::acos(-1.0) * i / count;
      scene.point({2 * std::cos(angle) - 2, 2 * std::sin(angle)}, random.between(0.3, 3));
    }
    const auto rod = [&](int a, int b) {
      scene.join(JointKind::kDistance, a, b, length(scene.at(b) - scene.at(a)));
    };
    for (int i = 0; i < count; ++i) rod(i, (i + 1) % count);
    if (count > 6) rod(1, 4);  // a brace, which makes a second loop
    ASSERT_EQ(scene.connect(), 0);
    for (int i = 0; i < 150; ++i) {
      scene.step(kDown);
      ASSERT_LE(scene.worstGap(), 1e-10) << round << " " << i;
    }
    EXPECT_EQ(scene.solver.counters().quarantined, 0u);
  }
}

TEST(JointSystem, HundredLinkedBodiesKeepTheirMomentum) {
  SceneRandom random;
  for (const bool has_loops : {false, true}) {
    JointScene scene = randomTree(random, 100, true);
    for (int i = 0; has_loops && i < 5; ++i) {
      const int a = random.below(50), b = 50 + random.below(50);
      const double distance = length(scene.at(a) - scene.at(b));
      if (distance > 0.5) scene.join(JointKind::kDistance, a, b, distance);
    }
    for (JointBody& body : scene.bodies) {
      body.velocity *= 0.1;
      body.spin *= 0.1;
    }
    ASSERT_EQ(scene.connect(), 0);
    scene.step({});
    const Vec2 start = scene.momentum();
    const double turning = scene.angularMomentum(), energy = scene.kinetic();
    double scale = 0;
    for (const JointBody& body : scene.bodies) scale += length(body.velocity) / body.inverse_mass;
    for (int i = 0; i < 1000; ++i) scene.step({});
    EXPECT_LE(length(scene.momentum() - start), 1e-12 * scale);
    EXPECT_LE(std::abs(scene.angularMomentum() - turning), 1e-10 * scale);
    EXPECT_LE(std::abs(scene.kinetic() - energy), 1e-2 * energy);
    EXPECT_LE(scene.worstGap(), 1e-10);
    EXPECT_EQ(scene.solver.counters().regularised, 0u);
  }
}

TEST(JointSystem, RedundantRowsAreDroppedAndCounted) {
  JointScene scene = test::nailed();
  scene.rigid({1, 0}, 1, 0.2);
  for (int i = 0; i < 3; ++i) scene.joinAt(JointKind::kHinge, 0, 1, {0, 0});
  scene.joinAt(JointKind::kDistance, 0, 1, {0, 0});
  scene.joints.back().anchor_b = {};
  scene.joints.back().length = 1;
  ASSERT_EQ(scene.connect(), 0);
  const double start = scene.energy(kDown);
  for (int i = 0; i < 300; ++i) {
    scene.step(kDown);
    ASSERT_LE(scene.worstGap(), 1e-10);
    ASSERT_NEAR(scene.energy(kDown), start, 1e-2);
  }
  EXPECT_GT(scene.solver.counters().dependent, 0u);
  EXPECT_EQ(scene.solver.counters().regularised, 0u);
}

TEST(JointSystem, ContradictionsStayBoundedAndAreCounted) {
  JointScene scene = test::nailed();
  scene.point({1, 0});
  scene.point({2.5, 0}, 0);
  scene.join(JointKind::kDistance, 0, 1, 1);
  scene.join(JointKind::kDistance, 1, 2, 1);  // the rod is half a cell too short
  ASSERT_EQ(scene.connect(), 0);
  for (int i = 0; i < 100; ++i) {
    scene.step(kDown);
    ASSERT_LE(length(scene.at(1)), 5);
    ASSERT_LE(length(scene.body(1).velocity), 100);
  }
  EXPECT_GT(scene.solver.counters().regularised, 0u);
}

TEST(JointSystem, FortyLegsOnOneBodyHold) {
  JointScene scene;
  scene.rigid({0, 0}, 5, 5);
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.157 * i;
    const int leg = scene.point({2 * std::cos(angle), 2 * std::sin(angle)}, 3);
    scene.join(JointKind::kDistance, 0, leg, 1).anchor_a = {std::cos(angle), std::sin(angle)};
  }
  scene.bodies[0].spin = 1;
  ASSERT_EQ(scene.connect(), 0);
  EXPECT_EQ(scene.solver.islands()[0].fill(), 0);
  scene.step({});
  const double turning = scene.angularMomentum();
  for (int i = 0; i < 100; ++i) {
    scene.step({});
    ASSERT_LE(scene.worstGap(), 1e-10);
  }
  EXPECT_NEAR(scene.angularMomentum(), turning, 1e-10);
}

TEST(JointSystem, InvalidNumbersAffectOnlyTheirGroup) {
  const double bad[] = {std::nan(""), kNoLimit, -kNoLimit, 1e30, 1e300};
  for (const double number : bad) {
    for (int where = 0; where < 3; ++where) {
      JointScene clean = test::ropeOf(5, 10), scene = test::ropeOf(5, 10);
      for (JointScene* each : {&clean, &scene}) {
        const int top = each->point({50, 0}, 0), end = each->point({51, 0});
        each->join(JointKind::kDistance, top, end, 1);
        each->connect();
      }
      for (int i = 0; i < 60; ++i) {
        if (i == 20) {
          JointBody& body = scene.bodies[2];
          (where == 0 ? body.velocity.x : where == 1 ? body.force.y : body.place.dx) = number;
        }
        clean.step(kDown);
        scene.step(kDown);
      }
      EXPECT_EQ(scene.solver.counters().quarantined, 1u) << number << " " << where;
      EXPECT_EQ(scene.bodies.back().velocity, clean.bodies.back().velocity);
      EXPECT_EQ(scene.bodies.back().place, clean.bodies.back().place);
      EXPECT_EQ(scene.bodies[3].velocity, Vec2{});
    }
  }
}

TEST(JointSystem, ExtremeMassesStepsAndSizesStayFinite) {
  for (const double mass : {1e-12, 1e-6, 1e6, 1e12}) {
    for (const double h : {1e-9, 1e-3, 1.0, 100.0}) {
      JointScene scene = test::ropeOf(6, mass);
      for (int i = 0; i < 20; ++i) scene.step(kDown, {}, h);
      for (const JointBody& body : scene.bodies) {
        ASSERT_TRUE(isFinite(body.velocity)) << mass << " " << h;
        ASSERT_LE(length(body.place - Place{}), 1000) << mass << " " << h;
      }
    }
  }
}

TEST(JointSystem, SameStartGivesTheSameBits) {
  SceneRandom random;
  JointScene one = randomTree(random, 30, false);
  one.connect();
  JointScene two = one;
  for (int i = 0; i < 100; ++i) {
    one.step(kDown);
    two.step(kDown);
    if (i == 50) two.connect();  // this must not change anything, because the solver keeps no hidden state
  }
  for (std::size_t i = 0; i < one.bodies.size(); ++i) {
    EXPECT_EQ(one.bodies[i].place, two.bodies[i].place);
    EXPECT_EQ(one.bodies[i].velocity, two.bodies[i].velocity);
  }
}

TEST(JointSystem, StepAllocatesNothing) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  SceneRandom random;
  JointScene scene = randomTree(random, 30, false);
  scene.point({0, 3});
  scene.join(JointKind::kRope, 0, 30, 3.1);
  Joint& mouse = scene.join(JointKind::kMouse, -1, 20);
  mouse.stiffness = 10;
  mouse.max_force = 2;
  scene.connect();
  scene.step(kDown);
  const auto before = naiad::test::allocationsSoFar();
  for (int i = 0; i < 50; ++i) scene.step(kDown);
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
}

}  // namespace
}  // namespace naiad::physics
