#include "physics/joint/JointStore.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

int JointStore::add(const Joint& joint, bool may_touch) {
  int id = limit();
  if (m_free.empty()) {
    m_entries.emplace_back();
  } else {
    id = m_free.back();
    m_free.pop_back();
  }
  m_entries[at(id)] = {joint, true, may_touch, {}};
  m_entries[at(id)].joint.is_broken = false;
  m_order.push_back(id);
  m_is_apart_sorted = false;
  ++m_changes;
  return id;
}

bool JointStore::set(int id, const Joint& joint) {
  Joint& own = m_entries[at(id)].joint;
  if (joint.kind != own.kind || joint.b != own.b || firstOf(joint) != firstOf(own)) return false;
  const bool is_broken = own.is_broken;
  if (rowsOf(joint) != rowsOf(own)) m_entries[at(id)].memory = {};
  own = joint;
  own.is_broken = is_broken;
  return true;
}

void JointStore::remove(int id) {
  m_entries[at(id)].exists = false;
  m_order.erase(std::find(m_order.begin(), m_order.end(), id));
  m_free.push_back(id);
  m_is_apart_sorted = false;
  ++m_changes;
}

void JointStore::sortApart() {
  m_is_apart_sorted = true;
  m_apart.clear();
  for (const int id : m_order) {
    const Joint& j = joint(id);
    if (m_entries[at(id)].may_touch || j.is_broken || j.kind == JointKind::kMouse) continue;
    m_apart.emplace_back(std::min(j.a, j.b), std::max(j.a, j.b));
  }
  std::sort(m_apart.begin(), m_apart.end());
}

bool JointStore::keepsApart(int a, int b) {
  if (!m_is_apart_sorted) sortApart();
  return std::binary_search(m_apart.begin(), m_apart.end(), std::pair(std::min(a, b), std::max(a, b)));
}

bool JointStore::finish(int id, Vec2 force, double torque) {
  Joint& own = m_entries[at(id)].joint;
  own.force = force;
  own.torque = torque;
  if (!(length(force) > own.break_force) && !(std::fabs(torque) > own.break_torque)) return false;
  own.is_broken = true;
  m_is_apart_sorted = false;
  ++m_changes;
  return true;
}

}  // namespace naiad::physics
