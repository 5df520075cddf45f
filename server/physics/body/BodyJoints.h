// The joints of a world's bodies.
//
// A joint stores the rows of its bodies in the BodyTable. A joint to the world stores its anchor as a Place,
// so that a scene moved by whole cells behaves identically.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyJoint.h"
#include "physics/geometry/Place.h"
#include "physics/joint/Joint.h"

namespace naiad::physics {

struct JointEntry {
  Joint joint;   ///< a and b are rows, or BodyJoints::kWorld
  Place anchor;  ///< point of the world that the joint holds; the joint's own anchor on that side is 0
  std::uint32_t generation = 0;
  bool used = false;
  std::uint32_t tunings = 0;  ///< counts changes of the joint's numbers (such as its length) by the game
};

class BodyJoints {
 public:
  static constexpr int kWorld = -1;  ///< replaces the row if a side is the world

  JointKey add(const Joint& joint, Place anchor);
  /// Returns null if the joint was removed, is broken, or one of its bodies is deleted.
  JointEntry* find(JointKey key);
  void remove(JointKey key);
  /// Removes all joints of a deleted body.
  void removeOf(int row);

  /// Returns all entries, including unused ones. Their order depends only on the previous calls.
  std::vector<JointEntry>& entries() { return m_entries; }
  const std::vector<JointEntry>& entries() const { return m_entries; }
  int count() const { return m_count; }
  /// Counts the changes after which groups must be found again: joints added or removed, and changes of
  /// bodies or joints for which markChanged() was called, such as a new mass.
  std::uint64_t changes() const { return m_changes; }
  void markChanged() { ++m_changes; }

 private:
  void drop(std::uint32_t index);

  std::vector<JointEntry> m_entries;
  std::vector<std::uint32_t> m_free;
  int m_count = 0;
  std::uint64_t m_changes = 0;
};

}  // namespace naiad::physics
