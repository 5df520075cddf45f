// Chooses the solver that moves each body in this tick, by what the body may touch directly and indirectly.
//
// Bodies that are joined, or whose paths in this tick may cross, are one island. An island without turning
// bodies, own shapes and joints goes to the event-exact ImpactWorld. If no body can touch anything, the
// JointSolver or each body's own flight moves it; if it consists of bouncing circles, some of them joined,
// the JointSolver does from impact to impact; all others go to the RigidWorld. An island too expensive for
// one of these goes to the SubstepWorld as a whole, and stays there until it touches nothing. An island that
// a RigidWorld gives up goes to a SubstepWorld with finer steps.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyLinks.h"
#include "physics/body/BodyState.h"
#include "physics/broadphase/ImpactTree.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

class BodyIslands {
 public:
  /// Sets the solvers of `states`, and marks kinematic bodies near rigid ones. Not needed while no HARD body
  /// is joined or other than a box or circle, and none was moved by the SubstepWorld.
  void chooseSolvers(const WorldStore& store, const BodyTable& table, const BodyLinks& links,
                     const BodyContacts& contacts, std::vector<BodyState>& states);
  /// Moves all bodies that may touch abandoned ones (`is_costly`) of the ImpactWorld to the SubstepWorld.
  void passToSubsteps(const BodyTable& table, std::vector<BodyState>& states);
  /// Call instead of chooseSolvers() if there are no islands.
  void skip() {
    m_candidates.clear();
    m_has_general = m_has_heaps = false;
  }
  /// Makes the next chooseSolvers() ignore which bodies the SubstepWorld moved before.
  void leaveSubsteps() { m_leaves_substeps = true; }
  /// True if the SubstepWorld moves any body.
  bool hasGeneral() const { return m_has_general; }
  /// True if any group is a heap.
  bool hasHeaps() const { return m_has_heaps; }
  /// Pairs of bodies with solver kJointImpacts, by group.
  const std::vector<BodyCandidatePair>& candidates() const { return m_candidates; }

 private:
  struct Group {
    bool is_rigid = false;    // not for an ImpactWorld
    bool is_general = false;  // for the SubstepWorld
    bool is_heap = false;     // for the SubstepWorld of heaps, unless is_general
    int bodies = 0;           // number of HARD bodies free to move
    bool may_touch = false;
    bool has_obstacle = false;
    bool is_elastic = true;  // only bouncing circles
    double fastest = 0;
    double max_inverse_mass = 0;  // among HARD bodies; 0: none is free to move
    double min_inverse_mass = 0;
  };

  SweptBox boxOf(const BodyState& state, Vec2 centre, bool is_alone) const;
  bool passesBy(const BodyState& flyer, const BodyState& other) const;
  void findPairs(const BodyTable& table, const std::vector<BodyState>& states);
  void addPair(const BodyTable& table, const std::vector<BodyState>& states, int i, int j);
  void uniteJointed(const BodyTable& table, const std::vector<BodyState>& states);
  void connect(const BodyTable& table, const std::vector<BodyState>& states);
  void classifyGroups(const BodyTable& table, const BodyLinks& links, const BodyContacts& contacts,
                      const std::vector<BodyState>& states);
  bool widenReaches(std::vector<BodyState>& states);
  void markKinematic(std::vector<BodyState>& states) const;
  void collectCandidates(std::vector<BodyState>& states);
  bool areJoined(const BodyTable& table, int row_a, int row_b);
  void findObstacles(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states);

  bool m_has_general = false, m_has_heaps = false;
  bool m_leaves_substeps = false;
  UnionFind m_sets;                        // of states
  std::vector<std::uint8_t> m_is_settled;  // by root; no further pair can change the kind of its group
  std::vector<Group> m_groups;
  std::vector<int> m_state_of;  // by row of the table
  ImpactTree m_tree;
  std::vector<SweptBox> m_boxes;
  std::vector<int> m_ids;
  std::vector<std::uint8_t> m_is_paired;  // by state
  const BodyState* m_p_states = nullptr;  // during findPairs()
  std::vector<std::pair<int, int>>
      m_pairs;  // pairs with overlapping reaches, without some within settled groups
  std::vector<std::pair<int, int>>
      m_touchable;  // those of m_pairs with a movable body and without a joint between them
  std::vector<BodyCandidatePair> m_candidates;
  std::vector<ObjectKey> m_found;
  std::vector<std::pair<int, int>> m_joined;  // sorted pairs of rows that a joint connects
  std::uint64_t m_joint_changes = 0;          // value of joints.changes() for which m_joined is valid
};

}  // namespace naiad::physics
