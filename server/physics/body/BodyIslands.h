// Which solver moves a body in this tick: decided by what it may touch, and what that may touch.
//
// Bodies that joints connect, or whose paths in this tick may cross, are one island. An island without
// turning bodies, shapes of their own and joints goes to the event-exact ImpactWorld; one in which no body
// can touch anything, to the JointSolver or to each body's own flight; one of circles that bounce, some of
// them joined, to the JointSolver from impact to impact; the others to the RigidWorld. What would cost one of
// these more than its size allows goes to the SubstepWorld as a whole, and stays until it touches nothing. So
// does what a RigidWorld gives up, to a SubstepWorld of finer steps.
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
  /// Sets the solvers of `states`, and which kinematic bodies are near rigid ones. Not needed while no HARD
  /// body is joined or more than a box or a circle, and none was moved by the SubstepWorld.
  void chooseSolvers(const WorldStore& store, const BodyTable& table, const BodyLinks& links,
                     const BodyContacts& contacts, std::vector<BodyState>& states);
  /// Of bodies that an ImpactWorld has given up (`is_costly`), all that may touch them in this tick is for
  /// the SubstepWorld.
  void passToSubsteps(const BodyTable& table, std::vector<BodyState>& states);
  /// No islands: instead of chooseSolvers().
  void skip() {
    m_candidates.clear();
    m_has_general = m_has_heaps = false;
  }
  /// In the next chooseSolvers() no body stays with the SubstepWorld because it was there.
  void leaveSubsteps() { m_leaves_substeps = true; }
  /// Is any body for the SubstepWorld?
  bool hasGeneral() const { return m_has_general; }
  /// Is any a heap?
  bool hasHeaps() const { return m_has_heaps; }
  /// Of bodies with solver kJointImpacts, by group.
  const std::vector<BodyCandidatePair>& candidates() const { return m_candidates; }

 private:
  struct Group {
    bool is_rigid = false;    // not for an ImpactWorld
    bool is_general = false;  // for the SubstepWorld
    bool is_heap = false;     // for that of heaps, unless it is general
    int bodies = 0;           // HARD and free to move
    bool may_touch = false;
    bool has_obstacle = false;
    bool is_elastic = true;  // circles that bounce
    double fastest = 0;
    double max_inverse_mass = 0;  // of the HARD ones; 0: none is free to move
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
  std::vector<std::uint8_t> m_is_settled;  // by root: no further pair of it would change what kind it is
  std::vector<Group> m_groups;
  std::vector<int> m_state_of;  // by row of the table
  ImpactTree m_tree;
  std::vector<SweptBox> m_boxes;
  std::vector<int> m_ids;
  std::vector<std::uint8_t> m_is_paired;     // by state
  const BodyState* m_p_states = nullptr;     // during findPairs()
  std::vector<std::pair<int, int>> m_pairs;  // whose reaches overlap, but not all of a settled group …
  std::vector<std::pair<int, int>>
      m_touchable;  // … of which one can be pushed, and no joint keeps them apart
  std::vector<BodyCandidatePair> m_candidates;
  std::vector<ObjectKey> m_found;
  std::vector<std::pair<int, int>> m_joined;  // rows that a joint connects, in order …
  std::uint64_t m_joint_changes = 0;          // … after as many changes of the joints
};

}  // namespace naiad::physics
