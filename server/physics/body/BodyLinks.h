// The bodies with joints that a JointSolver moves, and the springs on which a single body hangs.
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
  /// Finds the jointed groups again if joints have changed.
  void prepare(BodyTable& table);
  /// True if the row's body is joined, unless it only hangs on a spring of hangsOn().
  bool isJoined(BodyTable::Index row) const { return row < m_kinds.size() && m_kinds[row] == kJoined; }
  /// True if the row's body hangs in too many loops of joints for a direct solution.
  bool isCostly(BodyTable::Index row) const { return row < m_is_costly.size() && m_is_costly[row] != 0; }
  /// Returns the joint if it is the body's only one and a spring from the world to its centre; else null.
  const JointEntry* hangsOn(const BodyTable& table, BodyTable::Index row) const {
    if (row >= m_kinds.size() || m_kinds[row] < 0) return nullptr;
    return &table.joints.entries()[static_cast<std::size_t>(m_kinds[row])];
  }
  bool isEmpty() const { return m_joints.empty(); }
  /// Excludes the groups that a RigidWorld or SubstepWorld moves.
  void leaveOut(BodyTable& table, const std::vector<BodyState>& states);
  /// True if leaveOut() must be called even if no group touches anything.
  bool hasLeftOut() const { return m_has_left_out; }

  /// Steps all jointed bodies, and the bodies that they may hit, by a tick. `unit_inertias` has one number
  /// for each state; 0: the body does not turn. Groups that cannot be moved from impact to impact are passed
  /// to the RigidWorld and get the solver kRigid.
  void step(BodyTable& table, std::vector<BodyState>& states, const std::vector<double>& unit_inertias,
            const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts);

 private:
  static constexpr int kNoJoint = -1, kJoined = -2;  // m_kinds; other values: index of the spring it hangs on
  static constexpr std::uint32_t kPull = ~0U;

  int bodyOf(int row);
  bool findPulled(const std::vector<BodyState>& states);
  void collect(BodyTable& table);
  void countLoops(const BodyTable& table);
  void load(const BodyTable& table, const std::vector<BodyState>& states,
            const std::vector<double>& unit_inertias);
  void store(BodyTable& table, std::vector<BodyState>& states);
  int bodyAt(BodyTable::Index row) const { return row < m_body_of.size() ? m_body_of[row] : -1; }
  // Defined in BodyLinksImpacts.cpp:
  bool findFreeBodies(const std::vector<BodyState>& states);
  void stepImpacts(BodyTable& table, std::vector<BodyState>& states,
                   const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts);
  bool stepImpactGroup(const BodyTable& table, std::vector<BodyState>& states,
                       std::span<const BodyCandidatePair> candidates, BodyContacts& contacts);
  void passToRigidWorld(int group, BodyTable& table, std::vector<BodyState>& states, BodyContacts& contacts);

  JointSolver m_solver;
  std::uint64_t m_changes = 0;  // changes() of the table's joints when m_joints was made
  bool m_is_connected = false;
  bool m_has_left_out = false;
  std::vector<JointBody> m_bodies;
  std::vector<int> m_row_of;    // row, by body; −1: a point of the world
  std::vector<int> m_state_of;  // index of the state, by body
  std::vector<int> m_body_of;   // index of the body, by row
  std::vector<int> m_kinds;     // kNoJoint, kJoined or the index of a spring, by row
  std::vector<Joint> m_joints;
  std::vector<std::uint32_t> m_entry_of;  // index of the entry, by joint; kPull: not a joint of the table
  std::vector<std::uint32_t> m_tunings;   // by joint: tunings of the entry when it was copied
  std::vector<std::uint8_t> m_is_rigid;   // by row: 1 if leaveOut() excluded it
  std::vector<std::uint8_t> m_is_costly;  // by row; empty if no body is costly
  std::vector<BodyTable::Index> m_free_bodies,
      m_new_free_bodies;                                 // bodies without joints that may be hit; sorted
  std::vector<BodyTable::Index> m_pulled, m_new_pulled;  // joined bodies with a pull, sorted
  JointImpacts m_impacts;
  std::vector<JointPair> m_pairs;
  std::vector<std::uint8_t> m_is_moved;  // by island
};

}  // namespace naiad::physics
