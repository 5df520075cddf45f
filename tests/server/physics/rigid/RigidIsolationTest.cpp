// Groups that do not touch have no effect on each other: it does not matter to a group whether another one is
// solved by sweeps or directly.

#include <string>
#include <tuple>
#include <vector>

#include "RigidScene.h"

namespace naiad::physics {
namespace {

using namespace test;

constexpr int kGroupTicks = 200;
constexpr double kFar = 2000;  // cells between the groups
constexpr int kShotAt = 90;    // tick in which the bullet is shot at the sleeping crates

// The kinds of the other, distant group.
enum class Elsewhere { kNothing, kRest, kJoints, kHeap, kJointedHeap, kBullets };
enum class Added { kBefore, kAfter, kMidway };

class Scene {
 public:
  Scene(bool has_joints, Elsewhere elsewhere, Added added, bool is_removed)
      : m_has_joints(has_joints), m_elsewhere(elsewhere), m_added(added), m_is_removed(is_removed) {}

  std::vector<Bits> run() {
    if (m_added == Added::kBefore) addOthers();
    addWatched();
    if (m_added == Added::kAfter) addOthers();
    std::vector<Bits> seen;
    for (int tick = 0; tick < kGroupTicks; ++tick) {
      if (tick == 30 && m_added == Added::kMidway) addOthers();
      if (tick == 95 && m_is_removed) removeOthers();
      if (tick == kShotAt) shoot();
      m_world.step();
      for (const int id : m_watched) seen.push_back(bitsOf(m_world.body(id)));
      m_has_slept = m_has_slept || m_world.isAsleep(m_watched[0]);
      for (const int id : m_others)
        m_has_given_up = m_has_given_up || (m_world.exists(id) && m_world.isGivenUp(id));
    }
    return seen;
  }
  bool hasSlept() const { return m_has_slept; }
  bool hasGivenUpOthers() const { return m_has_given_up; }

 private:
  int add(Vec2 where, const ConvexShape& shape, double restitution = 0) {
    RigidBody body = movable(where, shape);
    body.restitution = restitution;
    return m_world.add(body, shape);
  }
  void join(JointKind kind, int a, int b) {
    const Vec2 arm = {kind == JointKind::kHinge ? 0.6 : 0, 0};
    EXPECT_GE(m_world.addJoint(jointOf(kind, a, b, {.length = 1.3, .stiffness = 0.1}, arm, -arm)), 0);
  }
  // Adds a stack, two pairs that fall onto the floor, a row of crates that falls asleep, and a bullet shot at
  // them.
  void addWatched() {
    m_world.add(immovable({0, 5}), boxShape(100, 5));
    for (int i = 0; i < 4; ++i) m_watched.push_back(add({0.1 * i, -0.5 - 1.0 * i}, boxShape(0.5, 0.5)));
    for (const double left : {10.0, 20.0}) {
      const int a = add({left, -3}, boxShape(0.5, 0.3)), b = add({left + 1.2, -3.2}, boxShape(0.4, 0.3));
      if (m_has_joints) join(left < 15 ? JointKind::kHinge : JointKind::kRope, a, b);
      m_watched.push_back(a);
      m_watched.push_back(b);
    }
    for (int i = 0; i < 3; ++i) m_watched.push_back(add({40 + 1.0 * i, -0.5}, boxShape(0.5, 0.5), 0.5));
    m_bullet = add({60, -0.3}, circleShape(0.1), 0.5);
    m_watched.push_back(m_bullet);
  }
  void shoot() {
    RigidBody bullet = m_world.body(m_bullet);
    bullet.velocity = {-40, 0};
    EXPECT_TRUE(m_world.set(m_bullet, bullet));
  }
  void addOthers() {
    if (m_elsewhere == Elsewhere::kNothing) return;
    m_others.push_back(m_world.add(immovable({kFar, 5}), boxShape(100, 5)));
    const bool is_heap = m_elsewhere == Elsewhere::kHeap || m_elsewhere == Elsewhere::kJointedHeap;
    const int count = is_heap ? 48 : 4;
    for (int i = 0; i < count; ++i) {
      const int id = add({kFar + 1.02 * (i % 8), -0.6 - 1.05 * (i / 8)}, boxShape(0.5, 0.5));
      m_others.push_back(id);
      RigidBody body = m_world.body(id);
      if (is_heap) body.velocity = {0.1 * (i % 3 - 1), 0.6};
      if (m_elsewhere == Elsewhere::kBullets) body.velocity = {1e5, -1e5}, body.spin = 1e3;
      m_world.set(id, body);
    }
    if (m_elsewhere == Elsewhere::kJoints || m_elsewhere == Elsewhere::kJointedHeap) {
      join(JointKind::kHinge, m_others[1], m_others[2]);
      join(JointKind::kSpring, m_others[3], m_others[4]);
    }
  }
  void removeOthers() {
    for (std::size_t i = 1; i < m_others.size(); i += 2) EXPECT_TRUE(m_world.remove(m_others[i]));
  }

  RigidWorld m_world;
  bool m_has_joints;
  Elsewhere m_elsewhere;
  Added m_added;
  bool m_is_removed;
  bool m_has_slept = false, m_has_given_up = false;
  std::vector<int> m_watched, m_others;
  int m_bullet = -1;
};

class RigidIsolation : public testing::TestWithParam<std::tuple<bool, Elsewhere>> {};

TEST_P(RigidIsolation, GroupMovesTheSameAloneAndBesideOthers) {
  const auto [has_joints, elsewhere] = GetParam();
  Scene alone(has_joints, Elsewhere::kNothing, Added::kAfter, false);
  const std::vector<Bits> expected = alone.run();
  EXPECT_TRUE(alone.hasSlept());
  for (const Added added : {Added::kBefore, Added::kAfter, Added::kMidway}) {
    for (const bool is_removed : {false, true}) {
      Scene beside(has_joints, elsewhere, added, is_removed);
      const std::vector<Bits> seen = beside.run();
      ASSERT_EQ(seen.size(), expected.size());
      std::size_t first = 0;
      while (first < seen.size() && seen[first] == expected[first]) ++first;
      const std::size_t bodies = expected.size() / kGroupTicks;
      EXPECT_EQ(first, seen.size()) << "tick " << first / bodies << ", body " << first % bodies << ", added "
                                    << static_cast<int>(added) << ", removed " << is_removed;
      const bool is_heap = elsewhere == Elsewhere::kHeap || elsewhere == Elsewhere::kJointedHeap;
      EXPECT_EQ(beside.hasGivenUpOthers(), is_heap);
    }
  }
}

std::string nameOf(const testing::TestParamInfo<std::tuple<bool, Elsewhere>>& its) {
  constexpr std::array<const char*, 6> kNames = {"Nothing", "Rest",        "Joints",
                                                 "Heap",    "JointedHeap", "Bullets"};
  const auto [has_joints, elsewhere] = its.param;
  return std::string(has_joints ? "Joined" : "Loose") + "Beside" +
         kNames[static_cast<std::size_t>(elsewhere)];
}

INSTANTIATE_TEST_SUITE_P(
    Groups, RigidIsolation,
    testing::Combine(testing::Bool(), testing::Values(Elsewhere::kRest, Elsewhere::kJoints, Elsewhere::kHeap,
                                                      Elsewhere::kJointedHeap, Elsewhere::kBullets)),
    nameOf);

}  // namespace
}  // namespace naiad::physics
