// The jointed bodies that a JointSolver moves, and springs that one body hangs on alone.
#pragma once

#include <vector>

#include "physics/body/BodyContacts.h"
#include "physics/body/BodyJoints.h"
#include "physics/body/BodyPlan.h"
#include "physics/joint/JointImpacts.h"
#include "physics/joint/JointSolver.h"

namespace naiad::physics {

class BodyLinks {
 public:
  /// Finds out anew who is joined to whom, if anything has changed.
  void prepare(BodyTable& table);
  /// Is the row's body one of those that step() moves?
  bool isJoined(BodyTable::Index row) const { return row < m_kinds.size() && m_kinds[row] == kJoined; }
  /// The joint, if its only one is a spring from the world to its middle; else null.
  const JointEntry* hangsOn(const BodyTable& table, BodyTable::Index row) const {
    if (row >= m_kinds.size() || m_kinds[row] < 0) return nullptr;
    return &table.joints.entries()[static_cast<std::size_t>(m_kinds[row])];
  }
  bool isEmpty() const { return m_joints.empty(); }
  /// Leaves the groups whose plans go to a RigidWorld to that.
  void leaveOut(BodyTable& table, const std::vector<BodyPlan>& plans);
  bool hasLeftOut() const { return m_has_left_out; }

  /// Lets a tick pass for all plans of joined bodies, and for those that these may meet. `unit_inertias` by
  /// plan; 0: it does not turn. Groups that cannot be moved from impact to impact are handed on: their plans
  /// are on the way kRigid then.
  void step(BodyTable& table, std::vector<BodyPlan>& plans, const std::vector<double>& unit_inertias,
            const std::vector<BodyMeeting>& meetings, BodyContacts& contacts);
  const JointCounters& counters() const { return m_solver.counters(); }

 private:
  static constexpr int kNoJoint = -1, kJoined = -2;  // else: the spring that it hangs on

  int bodyOf(int row);
  void collect(BodyTable& table);
  void load(const BodyTable& table, const std::vector<BodyPlan>& plans,
            const std::vector<double>& unit_inertias);
  void store(BodyTable& table, std::vector<BodyPlan>& plans);
  int bodyAt(BodyTable::Index row) const { return row < m_body_of.size() ? m_body_of[row] : -1; }
  // BodyStrikes.cpp
  bool findGuests(const std::vector<BodyPlan>& plans);
  void strike(BodyTable& table, std::vector<BodyPlan>& plans, const std::vector<BodyMeeting>& meetings,
              BodyContacts& contacts);
  bool strikeGroup(const BodyTable& table, std::vector<BodyPlan>& plans,
                   std::span<const BodyMeeting> meetings, BodyContacts& contacts);
  void handOn(int group, BodyTable& table, std::vector<BodyPlan>& plans, BodyContacts& contacts);

  JointSolver m_solver;
  std::uint64_t m_changes = 0;  // of the table's joints, as they were collected
  bool m_is_connected = false;
  bool m_has_left_out = false;
  std::vector<JointBody> m_bodies;
  std::vector<int> m_row_of;   // by body; −1: a point of the world
  std::vector<int> m_plan_of;  // by body
  std::vector<int> m_body_of;  // by row
  std::vector<int> m_kinds;    // by row
  std::vector<Joint> m_joints;
  std::vector<std::uint32_t> m_entry_of;                 // by joint
  std::vector<std::uint32_t> m_tunings;                  // by joint, as they were taken over
  std::vector<std::uint8_t> m_is_rigid;                  // by row: left out
  std::vector<BodyTable::Index> m_guests, m_new_guests;  // not joined, but may be struck by who is; in order
  JointImpacts m_impacts;
  std::vector<JointPair> m_pairs;
  std::vector<std::uint8_t> m_is_moved;  // by island
};

}  // namespace naiad::physics
