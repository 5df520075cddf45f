// The joints of a world's bodies.
//
// Of bodies the table knows their rows (BodyTable.h). A joint of a body with the world has its own place
// there, so that a scene that is moved by whole cells behaves the same.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyJoint.h"
#include "physics/geometry/Place.h"
#include "physics/joint/Joint.h"

namespace naiad::physics {

struct JointEntry {
  Joint joint;   ///< a and b are rows, or BodyJoints::kWorld
  Place anchor;  ///< of a joint with the world: where on it; the joint's anchor there is 0
  std::uint32_t generation = 0;
  bool used = false;
  std::uint32_t tunings = 0;  ///< how often the game has changed a number of it
};

class BodyJoints {
 public:
  static constexpr int kWorld = -1;  ///< in the place of a body's row

  JointKey add(const Joint& joint, Place anchor);
  /// Null once it is removed, broken, or one of its bodies is gone.
  JointEntry* find(JointKey key);
  void remove(JointKey key);
  /// A body dies: its joints go with it.
  void removeOf(int row);

  /// Used or not; their order depends only on the calls before.
  std::vector<JointEntry>& entries() { return m_entries; }
  const std::vector<JointEntry>& entries() const { return m_entries; }
  int count() const { return m_count; }
  /// Counts what came, went or was changed in kind: groups have to be found again.
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
