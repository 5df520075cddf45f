#include "physics/joint/JointSolver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

int JointSolver::connect(std::span<const JointBody> bodies, std::span<const Joint> joints) {
  const int count = static_cast<int>(bodies.size());
  for (const Joint& joint : joints) {
    if (!joint.is_broken && !isValid(joint, count)) return -1;
  }
  for (const JointBody& body : bodies) {
    if (!isValid(body)) return -1;
  }
  UnionFind sets;
  sets.reset(bodies.size());
  const auto movable = [&](int body) { return body >= 0 && isMovable(bodies[at(body)]); };
  for (const Joint& joint : joints) {
    if (joint.is_broken || joint.kind == JointKind::kMouse || !movable(joint.a) || !movable(joint.b))
      continue;
    sets.unite(joint.a, joint.b);
  }
  struct Group {
    std::vector<int> bodies, joints;
  };
  std::vector<Group> groups(bodies.size());  // by the lowest index of each group's movable bodies
  m_is_joined.assign(bodies.size(), 0);
  m_carriers.clear();
  for (int i = 0; i < static_cast<int>(joints.size()); ++i) {
    const Joint& joint = joints[at(i)];
    const int a = joint.kind == JointKind::kMouse ? -1 : joint.a;
    if (joint.is_broken || (!movable(a) && !movable(joint.b))) continue;
    Group& group = groups[at(sets.rootOf(movable(joint.b) ? joint.b : a))];
    group.joints.push_back(i);
    for (const int body : {a, joint.b}) {
      if (body < 0) continue;
      group.bodies.push_back(body);
      if (m_is_joined[at(body)] == 0 && !movable(body)) m_carriers.push_back(body);
      m_is_joined[at(body)] = 1;
    }
  }
  m_islands.clear();
  m_island_of.assign(bodies.size(), -1);
  for (Group& group : groups) {
    if (group.joints.empty()) continue;
    std::sort(group.bodies.begin(), group.bodies.end());
    group.bodies.erase(std::unique(group.bodies.begin(), group.bodies.end()), group.bodies.end());
    for (const int body : group.bodies) {
      if (movable(body)) m_island_of[at(body)] = static_cast<int>(m_islands.size());
    }
    m_islands.emplace_back(group.bodies, group.joints, bodies, joints);
  }
  m_joint_count = joints.size();
  return 0;
}

bool JointSolver::breakJoints(std::span<Joint> joints) {
  bool has_broken = false;
  for (Joint& joint : joints) {
    if (joint.is_broken) continue;
    const double most = joint.break_force;
    if (!(lengthSquared(joint.force) > most * most) && !(std::abs(joint.torque) > joint.break_torque))
      continue;
    joint.is_broken = has_broken = true;
    ++m_counters.broken;
  }
  return has_broken;
}

int JointSolver::step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
                      JointOptions options, std::span<const std::uint8_t> is_moved) {
  if (!(h > 0 && h <= 1e15) || !isFinite(gravity) || options.substeps < 1) return -1;
  if (bodies.size() != m_is_joined.size() || joints.size() != m_joint_count) return -1;
  for (std::size_t i = 0; i < m_islands.size(); ++i) {
    if (is_moved.empty() || is_moved[i] == 0)
      m_islands[i].step(bodies, joints, h, gravity, options, m_counters);
  }
  for (const int carrier : m_carriers) {
    JointBody& body = bodies[at(carrier)];
    if (!(lengthSquared(body.velocity) <= 1e30 && std::abs(body.spin) <= 1e15)) continue;
    if (body.velocity != Vec2{}) body.place = body.place + h * body.velocity;
    if (body.spin != 0) body.rotation = turned(body.rotation, h * body.spin);
  }
  if (breakJoints(joints)) connect(bodies, joints);
  return 0;
}

}  // namespace naiad::physics
