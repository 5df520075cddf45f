// Which solver a body goes to in this tick: by whom it may touch, and whom those may touch.
//
// Bodies that joints connect, or whose ways in this tick may meet, are one island. An island in which nobody
// turns, has a shape of his own or is joined goes to the event-exact ImpactWorld; one in which nobody can
// touch anything, to the JointSolver or nowhere; one of circles that bounce, some of them joined, to the
// JointSolver from impact to impact; the others to the RigidWorld.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyLinks.h"
#include "physics/body/BodyPlan.h"
#include "physics/broadphase/ImpactTree.h"

namespace df {

class BodyIslands {
 public:
  /// Sets the ways of `plans`, and who of the kinematic ones is near a rigid one. Not needed while no HARD
  /// body is joined or more than a box or a circle.
  void choose(const WorldStore& store, const naiad::physics::BodyTable& table,
              const naiad::physics::BodyLinks& links, const naiad::physics::BodyContacts& contacts,
              std::vector<naiad::physics::BodyPlan>& plans);
  /// Nobody meets anybody: instead of choose().
  void skip() { m_meetings.clear(); }
  /// Of those on the way kStruck, by group.
  const std::vector<naiad::physics::BodyMeeting>& meetings() const { return m_meetings; }

 private:
  struct Group {
    bool is_rigid = false;  // not for an ImpactWorld
    bool may_touch = false;
    bool has_obstacle = false;
    bool is_elastic = true;  // circles that bounce
    double fastest = 0;
  };

  int rootOf(int plan);
  void unite(int a, int b);
  void gather(const std::vector<naiad::physics::BodyPlan>& plans);
  void join(const naiad::physics::BodyTable& table, const std::vector<naiad::physics::BodyPlan>& plans);
  void connect(const naiad::physics::BodyTable& table, const std::vector<naiad::physics::BodyPlan>& plans);
  void judge(const naiad::physics::BodyTable& table, const naiad::physics::BodyLinks& links,
             const naiad::physics::BodyContacts& contacts,
             const std::vector<naiad::physics::BodyPlan>& plans);
  bool widen(std::vector<naiad::physics::BodyPlan>& plans);
  void meet(std::vector<naiad::physics::BodyPlan>& plans);
  bool areJoined(const naiad::physics::BodyTable& table, int row_a, int row_b) const;
  void lookAround(const WorldStore& store, const naiad::physics::BodyTable& table,
                  const std::vector<naiad::physics::BodyPlan>& plans);

  std::vector<int> m_parent;  // by plan
  std::vector<Group> m_groups;
  std::vector<int> m_plan_of;  // by row of the table
  naiad::physics::ImpactTree m_tree;
  std::vector<naiad::physics::SweptBox> m_boxes;
  std::vector<int> m_ids;
  std::vector<std::pair<int, int>> m_pairs;  // whose reaches overlap …
  std::vector<std::pair<int, int>>
      m_touchable;  // … of which one can be pushed, and no joint keeps them apart
  std::vector<naiad::physics::BodyMeeting> m_meetings;
  std::vector<ObjectKey> m_found;
};

}  // namespace df
