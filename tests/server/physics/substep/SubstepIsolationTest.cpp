// Groups that do not touch have no effect on each other: a group moves identically, bit for bit, alone and
// with others.

#include <algorithm>

#include "SubstepScene.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr int kGroupTicks = 200;
constexpr double kFar = 2000;  // cells between the groups

struct GroupKind {
  double restitution = 0;
  double mass = 1;
};

// A floor, a watched group, and another group that is added and removed. The watched bodies have ascending
// orders; the orders of the other bodies are between them.
class Neighbours {
 public:
  Neighbours(GroupKind watched, bool has_others, GroupKind others)
      : m_watched_kind(watched), m_others_kind(others), m_has_others(has_others) {
    const ConvexShape floor = boxShape(5000, 5);
    m_world.addInOrder(1, immovable({0, 5}), std::span(&floor, 1));
  }

  void run(std::vector<Bits>& seen) {
    for (int tick = 0; tick < kGroupTicks; ++tick) {
      change(tick);
      m_world.step();
      for (const int id : m_watched) seen.push_back(bitsOf(m_world.body(id)));
    }
  }
  const SubstepWorld& world() const { return m_world; }
  const std::vector<int>& watched() const { return m_watched; }

 private:
  void change(int tick) {
    if (tick == 0) addWatched(12);
    if (tick == 45) addWatched(4);
    if (tick == 110) addWatched(5);
    if (tick == 150) pushWatched();
    if (!m_has_others) return;
    if (tick == 3) addOthers(20);
    if (tick == 44) removeOthers(7);
    if (tick == 60) addOthers(15);
    if (tick == 109) removeOthers(100);
    if (tick == 130) addOthers(3);
  }
  static RigidBody bodyOf(int i, double left, bool is_disc, GroupKind kind) {
    const ConvexShape shape = shapeOf(is_disc);
    RigidBody body =
        movable({left + 1.05 * (i % 4) + 0.1 * (i % 3), -0.55 - 1.1 * (i / 4)}, shape, kind.mass);
    body.rotation = rotationBy(0.2 * i);
    body.restitution = kind.restitution;
    return body;
  }
  static ConvexShape shapeOf(bool is_disc) { return is_disc ? circleShape(0.45) : boxShape(0.5, 0.4); }
  int add(std::uint64_t order, int i, double left, GroupKind kind) {
    const bool is_disc = i % 3 == 1;
    const ConvexShape shape = shapeOf(is_disc);
    return m_world.addInOrder(order, bodyOf(i, left, is_disc, kind), std::span(&shape, 1));
  }
  void hinge(int a, int b) {
    const Joint joint = jointOf(JointKind::kHinge, a, b, {}, {0.55, 0}, {-0.55, 0});
    EXPECT_GE(m_world.addJoint(joint, false), 0);
  }
  // Joins the last three bodies. Joints that share a body are solved in the order of their addition.
  void chain(const std::vector<int>& of) {
    hinge(of[of.size() - 3], of[of.size() - 2]);
    hinge(of[of.size() - 2], of.back());
  }
  void addWatched(int count) {
    for (int i = 0; i < count; ++i) {
      m_order += m_has_others ? 1000 : 1;
      m_watched.push_back(add(m_order, static_cast<int>(m_watched.size()), 0, m_watched_kind));
    }
    chain(m_watched);
  }
  // Pushes a watched body, which sleeps or is about to sleep.
  void pushWatched() {
    RigidBody body = m_world.body(m_watched[3]);
    body.velocity = {-0.3, -0.2};
    EXPECT_TRUE(m_world.set(m_watched[3], body));
  }
  void addOthers(int count) {
    for (int i = 0; i < count; ++i) {
      m_others.push_back(add(m_order + 1 + m_added++, i, kFar, m_others_kind));
    }
    chain(m_others);
  }
  void removeOthers(int count) {
    for (; count > 0 && !m_others.empty(); --count) {
      EXPECT_TRUE(m_world.remove(m_others.front()));
      m_others.erase(m_others.begin());
    }
  }

  GroupKind m_watched_kind, m_others_kind;
  bool m_has_others;
  SubstepWorld m_world;
  std::vector<int> m_watched, m_others;
  std::uint64_t m_order = 10, m_added = 0;
};

void expectSameBits(GroupKind watched, GroupKind others) {
  Neighbours alone(watched, false, others), among(watched, true, others);
  std::vector<Bits> one, other;
  alone.run(one);
  among.run(other);
  ASSERT_EQ(one.size(), other.size());
  const auto first = std::mismatch(one.begin(), one.end(), other.begin()).first - one.begin();
  EXPECT_EQ(one, other) << "the first difference is entry " << first << " of " << one.size();
  // Checks that the scene has reused ids, and different ones.
  EXPECT_NE(alone.watched(), among.watched());
  EXPECT_FALSE(std::is_sorted(among.watched().begin(), among.watched().end()));
}

TEST(SubstepIsolation, GroupMovesTheSameAmongOthersOfAnyMass) {
  expectSameBits({}, {});
  expectSameBits({}, {.mass = 1e6});
  expectSameBits({}, {.mass = 1e-6});
}

// Rows of contacts that bounce are beside rows of inelastic ones.
TEST(SubstepIsolation, BouncingAndInelasticGroupsDoNotInteract) {
  expectSameBits({}, {.restitution = 0.7});
  expectSameBits({.restitution = 0.4}, {});
}

// Bodies with masses whose inverse a float cannot hold lie on the floor of the watched group.
TEST(SubstepIsolation, ExtremeMassesChangeNoOtherGroup) {
  for (const double mass : {1e30, 1e37, 1e40, 1e44, 1e60}) {
    SCOPED_TRACE(mass);
    expectSameBits({}, {.mass = mass});
  }
}

// Four bodies touch within one tick. Which is stopped first depends on their order, not on their ids.
TEST(SubstepIsolation, FastBodiesDoNotDependOnIds) {
  const auto meet = [](std::array<std::size_t, 4> added) {
    SubstepWorld world;
    const ConvexShape disc = circleShape(0.4);
    constexpr std::array<Vec2, 4> kPlaces = {Vec2{-40, 0}, {35, 0.1}, {0.1, -38}, {-0.2, 36}};
    std::array<int, 4> ids = {};
    for (const std::size_t i : added) {
      RigidBody body = floating(kPlaces[i], disc, -0.8 * kPlaces[i]);
      ids[i] = world.addInOrder(i + 1, body, std::span(&disc, 1));
    }
    std::vector<Bits> seen;
    for (int tick = 0; tick < 6; ++tick) {
      world.step();
      for (const int id : ids) seen.push_back(bitsOf(world.body(id)));
    }
    EXPECT_GT(world.counters().stopped, 0);
    return seen;
  };
  const std::vector<Bits> in_order = meet({0, 1, 2, 3});
  EXPECT_EQ(in_order, meet({3, 1, 0, 2}));
  EXPECT_EQ(in_order, meet({3, 2, 1, 0}));
}

}  // namespace
}  // namespace naiad::physics
