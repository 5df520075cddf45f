// The jointed bodies that a JointSolver moves, and springs on which a body hangs alone.
#pragma once

#include <vector>

#include "physics/body/BodyContacts.h"
#include "physics/body/BodyJoints.h"
#include "physics/body/BodyState.h"
#include "physics/joint/JointImpacts.h"
#include "physics/joint/JointSolver.h"

namespace naiad::physics {

class BodyLinks {
 public:
  /// Finds the jointed groups again, if anything has changed.
  void prepare(BodyTable& table);
  /// Is the row's body one of those that step() moves?
  bool isJoined(BodyTable::Index row) const { return row < m_kinds.size() && m_kinds[row] == kJoined; }
  /// Does the row's body hang in so many loops of joints that a direct solution would be too dear?
  bool isCostly(BodyTable::Index row) const { return row < m_is_costly.size() && m_is_costly[row] != 0; }
  /// The joint, if its only one is a spring from the world to its middle; else null.
  const JointEntry* hangsOn(const BodyTable& table, BodyTable::Index row) const {
    if (row >= m_kinds.size() || m_kinds[row] < 0) return nullptr;
    return &table.joints.entries()[static_cast<std::size_t>(m_kinds[row])];
  }
  bool isEmpty() const { return m_joints.empty(); }
  /// Leaves out the groups that a RigidWorld or a SubstepWorld moves.
  void leaveOut(BodyTable& table, const std::vector<BodyState>& states);
  /// Must leaveOut() be called even if no group touches anything?
  bool hasLeftOut() const { return m_has_left_out; }

  /// Steps all jointed bodies, and those that they may hit, by a tick. `unit_inertias` by
  /// state; 0: it does not turn. Groups that cannot be moved from impact to impact are passed to the
  /// RigidWorld: their solver is kRigid then.
  void step(BodyTable& table, std::vector<BodyState>& states, const std::vector<double>& unit_inertias,
            const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts);

 private:
  static constexpr int kNoJoint = -1, kJoined = -2;  // else: the spring that it hangs on
  static constexpr std::uint32_t kPull = ~0U;

  int bodyOf(int row);
  bool findPulled(const std::vector<BodyState>& states);
  void collect(BodyTable& table);
  void countLoops(const BodyTable& table);
  void load(const BodyTable& table, const std::vector<BodyState>& states,
            const std::vector<double>& unit_inertias);
  void store(BodyTable& table, std::vector<BodyState>& states);
  int bodyAt(BodyTable::Index row) const { return row < m_body_of.size() ? m_body_of[row] : -1; }
  // BodyLinksImpacts.cpp
  bool findFreeBodies(const std::vector<BodyState>& states);
  void stepImpacts(BodyTable& table, std::vector<BodyState>& states,
                   const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts);
  bool stepImpactGroup(const BodyTable& table, std::vector<BodyState>& states,
                       std::span<const BodyCandidatePair> candidates, BodyContacts& contacts);
  void passToRigidWorld(int group, BodyTable& table, std::vector<BodyState>& states, BodyContacts& contacts);

  JointSolver m_solver;
  std::uint64_t m_changes = 0;  // of the table's joints, as they were collected
  bool m_is_connected = false;
  bool m_has_left_out = false;
  std::vector<JointBody> m_bodies;
  std::vector<int> m_row_of;    // by body; −1: a point of the world
  std::vector<int> m_state_of;  // by body
  std::vector<int> m_body_of;   // by row
  std::vector<int> m_kinds;     // by row
  std::vector<Joint> m_joints;
  std::vector<std::uint32_t> m_entry_of;  // by joint; kPull: it is none of the table's
  std::vector<std::uint32_t> m_tunings;   // by joint, as they were taken over
  std::vector<std::uint8_t> m_is_rigid;   // by row: left out
  std::vector<std::uint8_t> m_is_costly;  // by row; empty: none is
  std::vector<BodyTable::Index> m_free_bodies,
      m_new_free_bodies;  // not joined, but may be hit by joined ones; in order
  std::vector<BodyTable::Index> m_pulled, m_new_pulled;  // joined bodies with a pull, in order
  JointImpacts m_impacts;
  std::vector<JointPair> m_pairs;
  std::vector<std::uint8_t> m_is_moved;  // by island
};

}  // namespace naiad::physics
