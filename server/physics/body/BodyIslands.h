// Which solver moves a body in this tick: decided by what it may touch, and what that may touch.
//
// Bodies that joints connect, or whose paths in this tick may cross, are one island. An island without
// turning bodies, shapes of their own and joints goes to the event-exact ImpactWorld; one in which no body
// can touch anything, to the JointSolver or to each body's own flight; one of circles that bounce, some of
// them joined, to the JointSolver from impact to impact; the others to the RigidWorld.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyLinks.h"
#include "physics/body/BodyState.h"
#include "physics/broadphase/ImpactTree.h"

namespace df {

class BodyIslands {
 public:
  /// Sets the solvers of `states`, and which kinematic bodies are near rigid ones. Not needed while no HARD
  /// body is joined or more than a box or a circle.
  void chooseSolvers(const WorldStore& store, const naiad::physics::BodyTable& table,
                     const naiad::physics::BodyLinks& links, const naiad::physics::BodyContacts& contacts,
                     std::vector<naiad::physics::BodyState>& states);
  /// No islands: instead of chooseSolvers().
  void skip() { m_candidates.clear(); }
  /// Of bodies with solver kJointImpacts, by group.
  const std::vector<naiad::physics::BodyCandidatePair>& candidates() const { return m_candidates; }

 private:
  struct Group {
    bool is_rigid = false;  // not for an ImpactWorld
    bool may_touch = false;
    bool has_obstacle = false;
    bool is_elastic = true;  // circles that bounce
    double fastest = 0;
  };

  int rootOf(int state);
  void unite(int a, int b);
  void findPairs(const std::vector<naiad::physics::BodyState>& states);
  void uniteJointed(const naiad::physics::BodyTable& table,
                    const std::vector<naiad::physics::BodyState>& states);
  void connect(const naiad::physics::BodyTable& table, const std::vector<naiad::physics::BodyState>& states);
  void classifyGroups(const naiad::physics::BodyTable& table, const naiad::physics::BodyLinks& links,
                      const naiad::physics::BodyContacts& contacts,
                      const std::vector<naiad::physics::BodyState>& states);
  bool widenReaches(std::vector<naiad::physics::BodyState>& states);
  void collectCandidates(std::vector<naiad::physics::BodyState>& states);
  bool areJoined(const naiad::physics::BodyTable& table, int row_a, int row_b) const;
  void findObstacles(const WorldStore& store, const naiad::physics::BodyTable& table,
                     const std::vector<naiad::physics::BodyState>& states);

  std::vector<int> m_parent;  // by state
  std::vector<Group> m_groups;
  std::vector<int> m_state_of;  // by row of the table
  naiad::physics::ImpactTree m_tree;
  std::vector<naiad::physics::SweptBox> m_boxes;
  std::vector<int> m_ids;
  std::vector<std::pair<int, int>> m_pairs;  // whose reaches overlap …
  std::vector<std::pair<int, int>>
      m_touchable;  // … of which one can be pushed, and no joint keeps them apart
  std::vector<naiad::physics::BodyCandidatePair> m_candidates;
  std::vector<ObjectKey> m_found;
};

}  // namespace df
