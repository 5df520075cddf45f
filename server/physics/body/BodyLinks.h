// The jointed bodies of a world, for the choice of their solver.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyJoints.h"
#include "physics/body/BodyTable.h"

namespace naiad::physics {

class BodyLinks {
 public:
  /// Call before the other functions if joints or bodies may have changed.
  void prepare(const BodyTable& table);
  /// True if the row's body is joined, unless it only hangs on a spring of hangsOn().
  bool isJoined(BodyTable::Index row) const { return row < m_kinds.size() && m_kinds[row] == kJoined; }
  /// True if the row's body hangs in too many loops of joints for a direct solution.
  bool isCostly(BodyTable::Index row) const { return row < m_is_costly.size() && m_is_costly[row] != 0; }
  /// Returns the joint if it is the body's only one and a spring from the world to its centre; else null.
  const JointEntry* hangsOn(const BodyTable& table, BodyTable::Index row) const {
    if (row >= m_kinds.size() || m_kinds[row] < 0) return nullptr;
    return &table.joints.entries()[static_cast<std::size_t>(m_kinds[row])];
  }

 private:
  static constexpr int kNoJoint = -1, kJoined = -2;  // m_kinds; other values: index of the spring it hangs on

  void findKinds(const BodyTable& table);
  void countLoops(const BodyTable& table);

  std::uint64_t m_changes = 0;            // changes() of the table's joints at the last prepare()
  std::vector<int> m_kinds;               // kNoJoint, kJoined or the index of a spring, by row
  std::vector<std::uint8_t> m_is_costly;  // by row; empty if no body is costly
};

}  // namespace naiad::physics
