#include "physics/body/BodyJoints.h"

namespace naiad::physics {

JointKey BodyJoints::add(const Joint& joint, Place anchor) {
  std::uint32_t index = 0;
  if (m_free.empty()) {
    index = static_cast<std::uint32_t>(m_entries.size());
    m_entries.emplace_back();
  } else {
    index = m_free.back();
    m_free.pop_back();
  }
  JointEntry& entry = m_entries[index];
  entry.joint = joint;
  entry.anchor = anchor;
  if (++entry.generation == 0) entry.generation = 1;
  entry.used = true;
  ++m_count;
  ++m_changes;
  return {index, entry.generation};
}

JointEntry* BodyJoints::find(JointKey key) {
  if (key.generation == 0 || key.index >= m_entries.size()) return nullptr;
  JointEntry& entry = m_entries[key.index];
  return entry.used && entry.generation == key.generation ? &entry : nullptr;
}

void BodyJoints::drop(std::uint32_t index) {
  m_entries[index].used = false;
  m_free.push_back(index);
  --m_count;
  ++m_changes;
}

void BodyJoints::remove(JointKey key) {
  if (find(key) != nullptr) drop(key.index);
}

void BodyJoints::removeOf(int row) {
  if (m_count == 0) return;
  for (std::uint32_t i = 0; i < m_entries.size(); ++i) {
    const JointEntry& entry = m_entries[i];
    if (entry.used && (entry.joint.a == row || entry.joint.b == row)) drop(i);
  }
}

}  // namespace naiad::physics
