// Tests the joints of a SubstepWorld.

#include <algorithm>
#include <vector>

#include "SubstepScene.h"

namespace naiad::physics {
namespace {

using namespace test;

// A crate that hangs on a fixed point, the nail.
struct Hanging : SubstepScene {
  explicit Hanging(Vec2 where, double spin = 0) : SubstepScene(awake()) {
    nail = addNail();
    RigidBody body = movable(where, crate_shape);
    body.spin = spin;
    crate = add(body, crate_shape);
  }
  const RigidBody& body() const { return world.body(crate); }

  ConvexShape crate_shape = boxShape(0.4, 0.2);
  int nail = -1, crate = -1;
};

TEST(SubstepJoints, HardJointsHoldASwingingCrate) {
  const struct {
    JointKind kind;
    Vec2 on_nail, on_crate;
    double length;
  } kCases[] = {{JointKind::kHinge, {}, {-2, 0}, 0},
                {JointKind::kDistance, {}, {}, 2},
                {JointKind::kWeld, {2, 0}, {}, 0}};
  for (const auto& its : kCases) {
    SCOPED_TRACE(static_cast<int>(its.kind));
    Hanging scene({2, 0});
    const int joint =
        scene.join({.length = its.length}, its.kind, scene.nail, scene.crate, its.on_nail, its.on_crate);
    ASSERT_EQ(joint, 0);
    double lowest = 0, farthest = 0;
    for (int tick = 0; tick < 300; ++tick) {
      scene.ticks(1);
      ASSERT_NEAR(scene.gap(joint), its.length, 1e-2) << tick;
      ASSERT_TRUE(its.kind != JointKind::kWeld || std::fabs(scene.body().rotation.s) < 1e-2) << tick;
      lowest = std::max(lowest, scene.at(scene.crate).y);
      farthest = std::min(farthest, scene.at(scene.crate).x);
    }
    if (its.kind == JointKind::kHinge) {
      EXPECT_GT(lowest, 1.9);
      EXPECT_LT(farthest, -1.8);  // the crate swings to the other side
    }
  }
}

TEST(SubstepJoints, ARopeOnlyPulls) {
  Hanging scene({0, 0.5});
  const int rope = scene.join({.length = 2}, JointKind::kRope, scene.nail, scene.crate);
  scene.ticks(10);  // the rope is slack, so that the crate falls freely
  EXPECT_NEAR(scene.at(scene.crate).y, 0.5 + 0.5 * kGravityPerTick * 100, 0.1 * kGravityPerTick * 100);
  EXPECT_NEAR(scene.body().velocity.y, 10 * kGravityPerTick, 1e-6);
  EXPECT_LE(scene.most(200, [&] { return scene.gap(rope); }), 2.01);
  EXPECT_NEAR(scene.at(scene.crate).y, 2, 0.01);
  EXPECT_NEAR(scene.world.joint(rope).force.y, -kGravityPerTick, 0.02 * kGravityPerTick);
}

TEST(SubstepJoints, SliderMovesOnlyAlongItsAxis) {
  Hanging scene({0, 0});
  const Vec2 axis = {0.6, 0.8};
  ASSERT_GE(scene.join({.axis = axis}, JointKind::kSlider, scene.nail, scene.crate), 0);
  scene.ticks(60);
  const Vec2 at = scene.at(scene.crate);
  EXPECT_NEAR(cross(axis, at), 0, 1e-2);
  EXPECT_NEAR(dot(axis, at) / (0.5 * 0.8 * kGravityPerTick * 3600), 1, 0.03);
  EXPECT_NEAR(scene.body().rotation.s, 0, 1e-2);
}

TEST(SubstepJoints, AMotorReachesItsSpeed) {
  Hanging scene({0, 0});
  ASSERT_GE(scene.join({}, JointKind::kHinge, scene.nail, scene.crate), 0);
  const int motor = scene.join({.speed = 0.1, .max_force = 0.01 / scene.body().inverse_inertia},
                               JointKind::kMotor, scene.nail, scene.crate);
  ASSERT_GE(motor, 0);
  scene.ticks(5);
  EXPECT_NEAR(scene.body().spin, 0.05, 1e-4);  // the torque of the motor is limited
  scene.ticks(20);
  EXPECT_NEAR(scene.body().spin, 0.1, 1e-4);
  Joint joint = scene.world.joint(motor);
  joint.speed = -0.1;
  ASSERT_TRUE(scene.world.setJoint(motor, joint));
  scene.ticks(40);
  EXPECT_NEAR(scene.body().spin, -0.1, 1e-4);
}

TEST(SubstepJoints, AnAngleLimitHolds) {
  for (const double spin : {0.05, -0.05}) {
    Hanging scene({0, 0}, spin);
    ASSERT_GE(scene.join({}, JointKind::kHinge, scene.nail, scene.crate), 0);
    const JointSettings limits = {.lower = -0.5, .upper = 0.8};
    ASSERT_GE(scene.join(limits, JointKind::kAngleLimit, scene.nail, scene.crate), 0);
    for (int tick = 0; tick < 100; ++tick) {
      scene.ticks(1);
      const double angle = angleOf(scene.body().rotation);
      ASSERT_GT(angle, -0.51) << spin << ' ' << tick;
      ASSERT_LT(angle, 0.81) << spin << ' ' << tick;
      if (tick != 5) continue;
      EXPECT_NEAR(scene.body().spin, spin, 1e-6);  // the spin is free within the limits
    }
    EXPECT_NEAR(scene.body().spin, 0, 0.01);
  }
}

TEST(SubstepJoints, ASpringStaysBounded) {
  for (int exponent = -2; exponent <= 12; ++exponent) {
    Hanging scene({3, 0});
    const double k = std::pow(10.0, exponent), reach = 4 + 2 * kGravityPerTick / k;
    ASSERT_GE(scene.join({.length = 2, .stiffness = k}, JointKind::kSpring, scene.nail, scene.crate), 0);
    for (int tick = 0; tick < 300; ++tick) {
      scene.ticks(1);
      ASSERT_LT(length(scene.at(scene.crate)), reach) << exponent << ' ' << tick;
      ASSERT_LT(scene.speed(scene.crate), 10) << exponent << ' ' << tick;
    }
    EXPECT_EQ(scene.world.counters().quarantined, 0) << exponent;
    if (exponent < 4) continue;
    EXPECT_NEAR(length(scene.at(scene.crate)), 2, 1e-2) << exponent;
  }
}

// Bodies of mass 1 hang from the world, one below the other.
TEST(SubstepJoints, ChainOfSpringsStaysBounded) {
  for (const int count : {2, 3, 5, 10, 30}) {
    for (const double length : {0.0, 1.0}) {
      for (const double ratio : {0.0, 0.1, 1.0}) {  // of the critical damping
        for (int exponent = 0; exponent <= 12; exponent += 2) {
          SCOPED_TRACE(testing::Message() << count << ' ' << length << ' ' << ratio << " 1e" << exponent);
          SubstepScene scene(awake());
          int last = scene.addNail();
          const double k = std::pow(10.0, exponent);
          std::vector<int> bodies;
          double deepest = 0;  // of the last body at rest
          for (int i = 0; i < count; ++i) {
            RigidBody body = floating({0, 1.0 + i}, boxShape(0.1, 0.1));
            body.inverse_inertia = 0;
            body.acceleration = {0, kGravityPerTick};
            const int next = scene.world.addInOrder(++scene.order, body, {});
            const JointSettings spring = {
                .length = length, .stiffness = k, .damping = ratio * 2 * std::sqrt(k)};
            ASSERT_GE(scene.join(spring, JointKind::kSpring, last, next), 0);
            bodies.push_back(last = next);
            deepest += length + (count - i) * kGravityPerTick / k;
          }
          double fastest = 0;
          const double farthest = 2 * deepest + count;
          for (int tick = 0; tick < 100; ++tick) {
            scene.ticks(1);
            for (const int id : bodies) {
              ASSERT_LT(length == 0 ? std::fabs(scene.at(id).x) : 0, 1e-6);
              ASSERT_LT(std::fabs(scene.at(id).y), farthest);
              fastest = std::max(fastest, scene.speed(id));
            }
          }
          EXPECT_LT(fastest, count * 3.0);
          if (exponent >= 4 && ratio > 0 && count <= 5) {
            EXPECT_NEAR(scene.at(last).y, deepest, 1e-3);
          }
        }
      }
    }
  }
}

// Each spring is solved alone, because there are too many loops.
TEST(SubstepJoints, NetOfStiffSpringsStaysCalm) {
  constexpr int kSide = 8;
  for (const double stiffness : {10.0, 1e3, 1e12}) {
    SubstepScene scene(awake());
    std::vector<int> ids;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2 where = {1.0 * (i % kSide), 1.0 * (i / kSide)};
      RigidBody body = i == 0 || i == kSide - 1 ? immovable(where) : movable(where, boxShape(0.1, 0.1));
      body.inverse_inertia = 0;
      ids.push_back(scene.world.addInOrder(++scene.order, body, {}));
      const JointSettings spring = {.length = 1, .stiffness = stiffness};
      if (i % kSide > 0) scene.join(spring, JointKind::kSpring, ids[at(i - 1)], ids[at(i)]);
      if (i >= kSide) scene.join(spring, JointKind::kSpring, ids[at(i - kSide)], ids[at(i)]);
    }
    const auto fastest = [&] { return scene.largest(ids, [&](int id) { return scene.speed(id); }); };
    EXPECT_LT(scene.most(300, fastest), 0.5) << stiffness;
  }
}

TEST(SubstepJoints, MotorDoesNotOpenItsHinge) {
  const ConvexShape box = boxShape(1, 1);
  for (const double arm : {0.0, 2.0, 5.0, 20.0}) {
    for (const double speed : {0.0, 0.01, 0.1}) {
      for (const double strength : {1.0, 100.0, kNoLimit}) {
        SCOPED_TRACE(testing::Message() << arm << ' ' << speed << ' ' << strength);
        SubstepScene scene(awake());
        const int nail = scene.addNail();
        const int crate = scene.add(movable({arm, 0}, box), box);
        const int hinge = scene.join({}, JointKind::kHinge, nail, crate, {}, {-arm, 0});
        scene.join({.speed = speed, .max_force = strength}, JointKind::kMotor, nail, crate);
        for (int tick = 0; tick < 300; ++tick) {
          scene.ticks(1);
          ASSERT_LE(scene.gap(hinge), 0.01 * std::max(arm, 0.1)) << tick;
        }
        EXPECT_NEAR(scene.world.body(crate).spin, speed, 1e-3);
      }
    }
  }
}

// A chain of hinged links, the last one with a large mass; the first link hangs on the world if `hangs`.
struct HeavyChain : SubstepScene {
  HeavyChain(int count, double mass, bool hangs) : SubstepScene(awake()) {
    const ConvexShape link = boxShape(0.4, 0.1);
    int last = hangs ? addNail({-0.4, 0}) : -1;
    for (int i = 0; i < count; ++i) {
      masses.push_back(i + 1 == count ? mass : 1);
      links.push_back(add(movable({0.8 * i, 0}, link, masses.back()), link));
      const Vec2 on_last = {i == 0 ? 0.0 : 0.4, 0};
      if (last >= 0) hinges.push_back(join({}, JointKind::kHinge, last, links.back(), on_last, {-0.4, 0}));
      last = links.back();
    }
  }
  double widest() const {
    return largest(hinges, [this](int hinge) { return gap(hinge); });
  }
  std::vector<int> links, hinges;
  std::vector<double> masses;
};

TEST(SubstepJoints, HeavyEndDoesNotOpenAChain) {
  for (const double mass : {1e3, 1e6}) {
    HeavyChain chain(20, mass, true);
    EXPECT_LT(chain.most(300, [&] { return chain.widest(); }), 0.05) << mass;
  }
}

TEST(SubstepJoints, FreeChainFallsAsFastAsABody) {
  for (const double mass : {1.0, 1e6}) {
    HeavyChain chain(50, mass, false);
    chain.setVelocity(chain.links[0], {0, -0.3});  // it also turns
    const auto centre = [&] {
      double sum = 0, moment = 0;
      for (std::size_t i = 0; i < chain.links.size(); ++i) {
        sum += chain.masses[i];
        moment += chain.masses[i] * chain.at(chain.links[i]).y;
      }
      return moment / sum;
    };
    chain.ticks(60);
    const double speed = -0.3 / (mass + 49);
    EXPECT_NEAR(centre(), 60 * speed + 0.5 * kGravityPerTick * 60 * 60, 1e-6) << mass;
    EXPECT_LT(chain.widest(), 0.02) << mass;
  }
}

TEST(SubstepJoints, WeakSpringSwingsAtItsFrequency) {
  Hanging scene({1, 0});
  ASSERT_GE(scene.join({.stiffness = 0.01}, JointKind::kSpring, scene.nail, scene.crate), 0);
  RigidBody body = scene.body();
  body.acceleration = {};
  ASSERT_TRUE(scene.world.set(scene.crate, body));
  const int half_turn = static_cast<int>(std::lround(std::numbers::pi / 0.1));
  scene.ticks(half_turn);
  EXPECT_NEAR(scene.at(scene.crate).x, -1, 0.1);
}

TEST(SubstepJoints, MouseJointForceStaysWithinItsLimit) {
  Hanging scene({0, 0});
  const JointSettings pull = {.stiffness = 0.1, .damping = 0.5, .max_force = 0.05, .target = placeAt({5, 0})};
  const int mouse = scene.join(pull, JointKind::kMouse, -1, scene.crate);
  ASSERT_GE(mouse, 0);
  scene.ticks(1);
  EXPECT_NEAR(scene.body().velocity.x, 0.05, 1e-4);
  for (int tick = 0; tick < 300; ++tick) {
    scene.ticks(1);
    ASSERT_LE(std::fabs(scene.world.joint(mouse).force.x), 0.05 * 1.001) << tick;
  }
  EXPECT_NEAR(scene.at(scene.crate).x, 5, 0.05);
  EXPECT_NEAR(scene.at(scene.crate).y, kGravityPerTick / 0.1, 0.05);
}

TEST(SubstepJoints, JointBreaksOnlyAboveItsForce) {
  for (const double factor : {0.5, 1.5}) {
    Hanging scene({0, 1});
    const int hinge = scene.join({.break_force = factor * kGravityPerTick}, JointKind::kHinge, scene.nail,
                                 scene.crate, {}, {0, -1});
    scene.ticks(30);
    EXPECT_EQ(scene.world.joint(hinge).is_broken, factor < 1);
    EXPECT_EQ(scene.world.counters().broken, factor < 1 ? 1 : 0);
    EXPECT_EQ(scene.at(scene.crate).y > 2, factor < 1);
    EXPECT_TRUE(scene.world.jointExists(hinge));
  }
}

TEST(SubstepJoints, JointedBodiesDoNotCollide) {
  for (const bool may_touch : {false, true}) {
    SubstepScene scene(awake());
    const ConvexShape crate = boxShape(0.5, 0.5);
    const int a = scene.add(floating({0, 0}, crate), crate), b = scene.add(floating({0.5, 0}, crate), crate);
    const int rope = scene.join({.length = 10}, JointKind::kRope, a, b, {}, {}, may_touch);
    ASSERT_GE(rope, 0);
    scene.ticks(30);
    EXPECT_EQ(length(scene.at(b) - scene.at(a)) > 0.9, may_touch);
    EXPECT_EQ(scene.world.counters().contacts > 0, may_touch);
    ASSERT_TRUE(scene.world.removeJoint(rope));
    scene.ticks(30);
    EXPECT_GT(length(scene.at(b) - scene.at(a)), 0.9);  // the bodies collide now
  }
}

TEST(SubstepJoints, BrokenJointLetsItsBodiesCollide) {
  SubstepScene scene(awake());
  const ConvexShape crate = boxShape(0.5, 0.5);
  const int a = scene.add(floating({0, 0}, crate), crate);
  const int b = scene.add(floating({0.5, 0}, crate, {0.01, 0}), crate);
  const int hinge = scene.join({.break_force = 1e-6}, JointKind::kHinge, a, b, {0.25, 0}, {-0.25, 0});
  scene.ticks(40);
  ASSERT_TRUE(scene.world.joint(hinge).is_broken);
  EXPECT_GT(scene.world.counters().contacts, 0);
}

TEST(SubstepJoints, RemovedBodyRemovesItsJoints) {
  Hanging scene({2, 0});
  const int hinge = scene.join({}, JointKind::kHinge, scene.nail, scene.crate, {}, {-2, 0});
  ASSERT_TRUE(scene.world.remove(scene.nail));
  EXPECT_FALSE(scene.world.jointExists(hinge));
  scene.ticks(10);
  EXPECT_EQ(scene.at(scene.crate).x, 2);
  EXPECT_EQ(scene.world.addJoint({}, false), -1);
}

TEST(SubstepJoints, AChainBearsALoad) {
  Hanging scene({0, 0.4});
  int last = scene.crate;
  std::vector<int> hinges = {scene.join({}, JointKind::kHinge, scene.nail, last, {}, {0, -0.4})};
  for (int i = 1; i < 8; ++i) {
    const double mass = i == 7 ? 10 : 1;
    const int next = scene.add(movable({0, 0.4 + 0.8 * i}, scene.crate_shape, mass), scene.crate_shape);
    hinges.push_back(scene.join({}, JointKind::kHinge, last, next, {0, 0.4}, {0, -0.4}));
    last = next;
  }
  scene.ticks(300);
  for (const int hinge : hinges) EXPECT_LE(scene.gap(hinge), 0.02) << hinge;
  EXPECT_NEAR(scene.world.joint(hinges[0]).force.y / -kGravityPerTick, 17, 0.5);
}

// A chain at rest sleeps. All of it wakes when its end is pulled.
TEST(SubstepJoints, AChainSleepsAndWakes) {
  Hanging scene({0, 0.4});
  scene.world.setSleeping(true);
  std::vector<int> links = {scene.crate};
  ASSERT_GE(scene.join({}, JointKind::kHinge, scene.nail, scene.crate, {}, {0, -0.4}), 0);
  for (int i = 1; i < 4; ++i) {
    links.push_back(scene.add(movable({0, 0.4 + 0.8 * i}, scene.crate_shape), scene.crate_shape));
    ASSERT_GE(scene.join({}, JointKind::kHinge, links[at(i - 1)], links[at(i)], {0, 0.4}, {0, -0.4}), 0);
  }
  scene.ticks(200);
  for (const int link : links) ASSERT_TRUE(scene.world.isAsleep(link)) << link;
  scene.setVelocity(links.back(), {0.3, 0});
  scene.ticks(1);
  for (const int link : links) EXPECT_FALSE(scene.world.isAsleep(link)) << link;
  EXPECT_GT(std::fabs(scene.at(links[1]).x), 1e-4);
}

// A disc on a bridge of hinged planks, both ends of which are fixed; it lies there, or falls.
TEST(SubstepJoints, BridgesBearHeavyLoads) {
  constexpr int kPlanks = 30;
  const ConvexShape plank = boxShape(0.5, 0.1), disc = circleShape(1);
  for (const double mass : {1e2, 1e3, 1e4}) {
    for (const double drop : {0.0, 1.0}) {
      SCOPED_TRACE(testing::Message() << mass << ' ' << drop);
      SubstepScene scene(awake());
      const double run = 0.95, rise = std::sqrt(1 - run * run);
      int last = scene.addNail();
      Vec2 end = {};
      std::vector<int> hinges;
      for (int i = 0; i < kPlanks; ++i) {
        const Vec2 along = {run, i < kPlanks / 2 ? rise : -rise};
        RigidBody body = movable(end + 0.5 * along, plank);
        body.rotation = {along.x, along.y};
        end += along;
        const int next = scene.add(body, plank);
        hinges.push_back(scene.join({}, JointKind::kHinge, last, next, {i == 0 ? 0 : 0.5, 0}, {-0.5, 0}));
        last = next;
      }
      const int nail = scene.addNail(end);
      hinges.push_back(scene.join({}, JointKind::kHinge, last, nail, {0.5, 0}));
      const int load =
          scene.add(movable({0.5 * end.x + 0.3, 0.5 * kPlanks * rise - 1.3 - drop}, disc, mass), disc);
      double widest = 0, deepest = 0;
      for (int tick = 0; tick < 300; ++tick) {
        scene.ticks(1);
        for (const int hinge : hinges) widest = std::max(widest, scene.gap(hinge));
        deepest = std::max(deepest, scene.world.deepest());
      }
      EXPECT_LT(widest, mass < 1e4 ? 0.3 : 1.06);
      EXPECT_LT(deepest, mass < 1e4 ? 0.1 : 0.3);
      EXPECT_LT(scene.at(load).y, 0.5 * kPlanks * rise);
    }
  }
}

// A rope of discs on rods over a static wheel, with equal loads at its ends.
TEST(SubstepJoints, PulleysBearHeavyLoads) {
  constexpr int kDiscs = 62;
  const ConvexShape wheel = circleShape(5), disc = circleShape(0.25);
  for (const double mass : {1e2, 1e3, 1e4}) {
    SubstepScene scene(awake());
    RigidBody axle = immovable({0, 0});
    axle.friction = 0;
    scene.add(axle, wheel);
    const double radius = 5.25, turn = std::numbers::pi * radius, down = 0.5 * (0.5 * (kDiscs - 1) - turn);
    std::vector<int> rods;
    int last = -1;
    for (int i = 0; i < kDiscs; ++i) {
      const double along = std::clamp(0.5 * i - down, 0.0, turn) / radius;
      const double below = std::max({down - 0.5 * i, 0.5 * i - down - turn, 0.0});
      const Vec2 where = {-radius * std::cos(along), below - radius * std::sin(along)};
      const int next = scene.add(movable(where, disc, i == 0 || i + 1 == kDiscs ? mass : 1), disc);
      if (last >= 0) {
        const double length = naiad::physics::length(scene.at(next) - scene.at(last));
        rods.push_back(scene.join({.length = length}, JointKind::kDistance, last, next));
      }
      last = next;
    }
    double widest = 0, deepest = 0;
    for (int tick = 0; tick < 300; ++tick) {
      scene.ticks(1);
      for (const int rod : rods)
        widest = std::max(widest, std::fabs(scene.gap(rod) - scene.world.joint(rod).length));
      deepest = std::max(deepest, scene.world.deepest());
    }
    EXPECT_LT(widest, 0.1) << mass;
    EXPECT_LT(deepest, 0.1) << mass;
  }
}

}  // namespace
}  // namespace naiad::physics
