#include "physics/body/BodyIslands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/body/BodyObstacles.h"
#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// Maximum number of HARD bodies in an island. For larger islands, direct solutions are too slow for a tick,
// and sweeps are not better than soft sub-steps, whose cost is only proportional to the contacts.
constexpr int kMaxBodies = 640;

// Groups with a larger ratio of masses also go to the SubstepWorld. A direct solution holds them at rest, but
// in a blow it has no digits left for the lightest body, which would be thrown or pressed into the floor.
constexpr double kMaxMassRatio = 1e6;
constexpr double kMaxRestingRatio = 1e9;
constexpr double kBlow = 0.1;  // metric cells per tick: a group without a faster body cannot have a blow

// A path longer than this many body sizes is tested as a line, not as a square around its start.
constexpr double kLongPath = 8;

bool hasLongPath(const BodyState& state) {
  const Vec2 d = state.flown.displacement;
  return std::abs(d.x) + std::abs(d.y) > kLongPath * (state.size.x + state.size.y);
}

bool isLine(const BodyState& state) {
  return hasLongPath(state) && !state.is_bent && !state.is_joined && !state.is_kinematic;
}

}  // namespace

// Returns the area that the body may reach in this tick: its whole reach. If its path is long and no other
// body that could deflect it was found on it (`is_alone`), returns only the path.
SweptBox BodyIslands::boxOf(const BodyState& state, Vec2 centre, bool is_alone) const {
  const Vec2 d = state.flown.displacement;
  if (!is_alone || !isLine(state)) return {centre - state.reach, centre + state.reach};
  return {centre + Vec2{std::min(d.x, 0.0), std::min(d.y, 0.0)} - state.size,
          centre + Vec2{std::max(d.x, 0.0), std::max(d.y, 0.0)} + state.size};
}

// True if `flyer` has a long path on which no body was found yet, and the reach of `other` is not on it.
bool BodyIslands::passesBy(const BodyState& flyer, const BodyState& other) const {
  if (m_is_paired[at(static_cast<int>(&flyer - m_p_states))] != 0 || !isLine(flyer)) return false;
  const Vec2 along = flyer.flown.displacement / length(flyer.flown.displacement);
  const Vec2 across = {std::abs(along.y), std::abs(along.x)};
  return std::abs(cross(along, other.start - flyer.start)) > dot(across, flyer.size + other.reach);
}

// Adds a pair and unites its bodies. A kinematic body belongs to no group, so that all of its pairs are
// found. A group is settled when two of its bodies may touch, because further pairs would not change the
// result of classifyGroups().
void BodyIslands::addPair(const BodyTable& table, const std::vector<BodyState>& states, int i, int j) {
  m_pairs.emplace_back(i, j);
  const BodyState &a = states[at(i)], &b = states[at(j)];
  if (a.is_kinematic || b.is_kinematic) return;
  bool is_settled = m_is_settled[at(m_sets.rootOf(i))] != 0 || m_is_settled[at(m_sets.rootOf(j))] != 0;
  if (!is_settled) {
    is_settled =
        table.joints.count() == 0 || !areJoined(table, static_cast<int>(a.index), static_cast<int>(b.index));
  }
  m_sets.unite(i, j);
  m_is_settled[at(m_sets.rootOf(i))] = is_settled ? 1 : 0;
}

// Finds the pairs of HARD bodies that may touch, in any order. Searches again if a body is found on a long
// path, because it may deflect the fast body, which may then touch others.
void BodyIslands::findPairs(const BodyTable& table, const std::vector<BodyState>& states) {
  m_ids.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].is_hard && states[i].p_failure == nullptr) m_ids.push_back(static_cast<int>(i));
  }
  m_is_paired.assign(states.size(), 0);
  m_p_states = states.data();
  for (bool is_more = true; is_more;) {
    is_more = false;
    m_boxes.clear();
    m_pairs.clear();
    m_is_settled.assign(states.size(), 0);
    m_sets.reset(states.size());
    for (const int i : m_ids) {
      const BodyState& state = states[at(i)];
      m_boxes.push_back(boxOf(state, state.start - states[at(m_ids[0])].start, m_is_paired[at(i)] == 0));
    }
    m_tree.update(m_boxes, m_ids, static_cast<int>(states.size()));
    const auto areOne = [&](int i, int j) {
      const int root = m_sets.rootOf(i);
      return root == m_sets.rootOf(j) && m_is_settled[at(root)] != 0;
    };
    m_tree.queryGroups(
        [&](int i, int j) {
          if (passesBy(states[at(i)], states[at(j)]) || passesBy(states[at(j)], states[at(i)])) return;
          addPair(table, states, i, j);
        },
        areOne);
    for (const auto& [i, j] : m_pairs) {
      for (const int k : {i, j}) {
        is_more = is_more || (m_is_paired[at(k)] == 0 && hasLongPath(states[at(k)]));
        m_is_paired[at(k)] = 1;
      }
    }
  }
}

void BodyIslands::uniteJointed(const BodyTable& table, const std::vector<BodyState>& states) {
  m_state_of.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].index >= m_state_of.size()) m_state_of.resize(states[i].index + 1, -1);
    m_state_of[states[i].index] = static_cast<int>(i);
  }
  const auto stateOf = [&](int row) {
    return row >= 0 && row < static_cast<int>(m_state_of.size()) ? m_state_of[at(row)] : -1;
  };
  for (const JointEntry& entry : table.joints.entries()) {
    if (!entry.used) continue;
    const int a = stateOf(entry.joint.a), b = stateOf(entry.joint.b);
    if (a < 0 || b < 0 || states[at(a)].is_kinematic || states[at(b)].is_kinematic) continue;
    m_sets.unite(a, b);
  }
}

bool BodyIslands::areJoined(const BodyTable& table, int row_a, int row_b) {
  if (m_joint_changes != table.joints.changes()) {
    m_joint_changes = table.joints.changes();
    m_joined.clear();
    for (const JointEntry& entry : table.joints.entries()) {
      if (entry.used) m_joined.push_back(std::minmax(entry.joint.a, entry.joint.b));
    }
    std::sort(m_joined.begin(), m_joined.end());
  }
  return std::binary_search(m_joined.begin(), m_joined.end(), std::pair<int, int>(std::minmax(row_a, row_b)));
}

// Finds which islands have obstacles nearby, except islands for an ImpactWorld.
void BodyIslands::findObstacles(const WorldStore& store, const BodyTable& table,
                                const std::vector<BodyState>& states) {
  for (const int i : m_ids) {
    Group& group = m_groups[at(m_sets.rootOf(i))];
    const BodyState& state = states[at(i)];
    if (!group.is_rigid || group.may_touch || state.is_kinematic) continue;
    m_found.clear();
    store.touching(regionOf(table.metric, state.start, state.reach), state.key.slot, m_found);
    group.may_touch = std::any_of(m_found.begin(), m_found.end(),
                                  [&store](ObjectKey key) { return BodyObstacles::isObstacle(store, key); });
  }
}

void BodyIslands::connect(const BodyTable& table, const std::vector<BodyState>& states) {
  findPairs(table, states);
  uniteJointed(table, states);
}

// Finds the kind of each group, and lists the pairs that may touch.
void BodyIslands::classifyGroups(const BodyTable& table, const BodyLinks& links, const BodyContacts& contacts,
                                 const std::vector<BodyState>& states) {
  m_groups.assign(states.size(), {});
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool is_heap = states[i].is_in_heap;
    if (states[i].is_kinematic || !(is_heap || states[i].is_costly || states[i].must_be_held)) continue;
    Group& group = m_groups[at(m_sets.rootOf(static_cast<int>(i)))];
    group.is_general = group.is_general || states[i].is_costly;
    group.is_heap = group.is_heap || is_heap;
    group.is_rigid = group.may_touch = true;
  }
  for (const int i : m_ids) {
    const BodyState& state = states[at(i)];
    if (state.is_kinematic) continue;
    Group& group = m_groups[at(m_sets.rootOf(i))];
    const auto last_solver = static_cast<BodySolver>(table.row(state.index).last_solver);
    const bool may_stay = last_solver == BodySolver::kRigid || isSoft(last_solver);
    const bool stays = may_stay && contacts.isTouching(state.key);
    group.is_general =
        group.is_general || (stays && last_solver == BodySolver::kSubstep && !m_leaves_substeps);
    group.is_heap = group.is_heap || (stays && last_solver == BodySolver::kHeap);
    ++group.bodies;
    const double inverse_mass = table.row(state.index).inverse_mass;
    group.max_inverse_mass = std::max(group.max_inverse_mass, inverse_mass);
    group.min_inverse_mass =
        group.min_inverse_mass > 0 ? std::min(group.min_inverse_mass, inverse_mass) : inverse_mass;
    const bool is_joined = links.isJoined(state.index);
    group.may_rest = group.may_rest || is_joined || table.row(state.index).restitution < 1;
    group.is_rigid = group.is_rigid || !state.is_simple || stays || is_joined;
    group.fastest = std::max(group.fastest, length(state.start_velocity) + length(state.push));
  }
  const bool has_joints = table.joints.count() > 0;
  for (const auto& [i, j] : m_pairs) {
    const BodyState &a = states[at(i)], &b = states[at(j)];
    if (a.is_kinematic && b.is_kinematic) continue;
    if (has_joints && areJoined(table, static_cast<int>(a.index), static_cast<int>(b.index))) continue;
    Group& group = m_groups[at(m_sets.rootOf(a.is_kinematic ? j : i))];
    group.may_touch = true;
    const BodyState& other = a.is_kinematic ? a : b;
    if (other.is_kinematic && !other.is_simple) group.is_rigid = true;
  }
}

// Marks the kinematic bodies on the paths of bodies that a RigidWorld or SubstepWorld moves.
void BodyIslands::markKinematic(std::vector<BodyState>& states) const {
  for (const auto& [i, j] : m_pairs) {
    BodyState &a = states[at(i)], &b = states[at(j)];
    if (a.is_kinematic == b.is_kinematic) continue;
    BodyState& kinematic = a.is_kinematic ? a : b;
    const BodySolver solver = (a.is_kinematic ? b : a).solver;
    if (solver == BodySolver::kRigid) kinematic.is_near_rigid = true;
    if (isSoft(solver)) kinematic.is_near_substep = true;
  }
}

void BodyIslands::passToSubsteps(const BodyTable& table, std::vector<BodyState>& states) {
  connect(table, states);
  m_groups.assign(states.size(), {});
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].is_costly && !states[i].is_kinematic)
      m_groups[at(m_sets.rootOf(static_cast<int>(i)))].is_general = true;
  }
  for (const int i : m_ids) {
    BodyState& state = states[at(i)];
    if (state.solver == BodySolver::kImpact && !state.is_kinematic &&
        m_groups[at(m_sets.rootOf(i))].is_general)
      state.solver = BodySolver::kSubstep;
  }
  markKinematic(states);
}

void BodyIslands::chooseSolvers(const WorldStore& store, const BodyTable& table, const BodyLinks& links,
                                const BodyContacts& contacts, std::vector<BodyState>& states) {
  connect(table, states);
  classifyGroups(table, links, contacts, states);
  m_leaves_substeps = false;
  findObstacles(store, table, states);
  m_has_general = m_has_heaps = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    BodyState& state = states[i];
    const Group& group = m_groups[at(m_sets.rootOf(static_cast<int>(i)))];
    if (state.p_failure != nullptr || state.is_kinematic) continue;
    const double max_ratio = group.fastest > kBlow ? kMaxMassRatio : kMaxRestingRatio;
    const bool is_unequal = group.max_inverse_mass > max_ratio * group.min_inverse_mass;
    const bool needs_substeps = group.bodies > kMaxBodies || (is_unequal && group.may_rest);
    const bool is_general = group.is_general || (group.is_rigid && group.may_touch && needs_substeps);
    if (is_general || group.is_heap) {
      if (!state.is_hard && !state.is_joined && !state.must_be_held) continue;
      state.solver = is_general ? BodySolver::kSubstep : BodySolver::kHeap;
      (is_general ? m_has_general : m_has_heaps) = true;
    } else if (group.is_rigid && group.may_touch) {
      state.solver = BodySolver::kRigid;
    } else if (links.isJoined(state.index)) {
      state.is_alone = true;
    } else {
      state.solver = state.is_hard && state.is_simple ? BodySolver::kImpact : BodySolver::kFlight;
    }
  }
  markKinematic(states);
  for (BodyState& state : states) {
    if (!state.is_kinematic || !links.isJoined(state.index)) continue;
    state.is_near_rigid = true;  // because bodies joined to it may be near rigid ones
    state.is_near_substep = m_has_general || m_has_heaps;
  }
}

}  // namespace naiad::physics
