// Chooses the solver that moves each body in this tick, by what the body may touch directly and indirectly.
//
// Bodies that are joined, or whose paths in this tick may cross, are one island. An island without turning
// bodies, own shapes and joints goes to the event-exact ImpactWorld. If a body without joints cannot touch
// anything, its own flight moves it. All other islands go to the RigidWorld. An island too expensive for
// these goes to the SubstepWorld as a whole, and stays there until it touches nothing. An island that a
// RigidWorld abandons goes to a SubstepWorld with finer steps.
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
  /// Sets the solvers of `states`, and marks kinematic bodies near rigid ones. Not needed while all HARD
  /// bodies are boxes or circles without joints and the SubstepWorld moved none of them.
  void chooseSolvers(const WorldStore& store, const BodyTable& table, const BodyLinks& links,
                     const BodyContacts& contacts, std::vector<BodyState>& states);
  /// Moves all bodies that may touch abandoned ones (`is_costly`) of the ImpactWorld to the SubstepWorld.
  void passToSubsteps(const BodyTable& table, std::vector<BodyState>& states);
  /// Call instead of chooseSolvers() in a tick without islands.
  void skip() { m_has_general = m_has_heaps = false; }
  /// Makes the next chooseSolvers() ignore which bodies the SubstepWorld moved before.
  void leaveSubsteps() { m_leaves_substeps = true; }
  /// True if the SubstepWorld moves any body.
  bool hasGeneral() const { return m_has_general; }
  /// True if any group is a heap.
  bool hasHeaps() const { return m_has_heaps; }

 private:
  struct Group {
    bool is_rigid = false;    // the group cannot be moved by an ImpactWorld
    bool is_general = false;  // the SubstepWorld moves the group
    bool is_heap = false;     // the SubstepWorld of heaps moves the group, unless is_general
    int bodies = 0;           // number of HARD bodies free to move
    bool may_touch = false;
    bool may_rest = false;  // true unless every impact keeps the energy, so that no blow presses a heap
    double fastest = 0;
    double max_inverse_mass = 0;  // maximum among HARD bodies; 0: none is free to move
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
  void markKinematic(std::vector<BodyState>& states) const;
  bool areJoined(const BodyTable& table, int row_a, int row_b);
  void findObstacles(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states);

  bool m_has_general = false, m_has_heaps = false;
  bool m_leaves_substeps = false;
  UnionFind m_sets;                        // sets of states
  std::vector<std::uint8_t> m_is_settled;  // by root of m_sets: no further pair can change its group's kind
  std::vector<Group> m_groups;
  std::vector<int> m_state_of;  // index of the state, by row of the table
  ImpactTree m_tree;
  std::vector<SweptBox> m_boxes;
  std::vector<int> m_ids;
  std::vector<std::uint8_t> m_is_paired;  // by state: 1 if it is in a pair
  const BodyState* m_p_states = nullptr;  // the states; only valid during findPairs()
  std::vector<std::pair<int, int>>
      m_pairs;  // pairs with overlapping reaches, without some pairs within settled groups
  std::vector<ObjectKey> m_found;
  std::vector<std::pair<int, int>> m_joined;  // sorted pairs of rows that a joint connects
  std::uint64_t m_joint_changes = 0;          // value of joints.changes() for which m_joined is valid
};

}  // namespace naiad::physics
