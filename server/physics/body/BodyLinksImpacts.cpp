// Moves groups of bouncing circles, some of them joined, from impact to impact (JointImpacts).
#include <algorithm>
#include <cmath>

#include "physics/body/BodyLinks.h"
#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

bool isBefore(const BodyState& a, const BodyState& b) {
  return a.order < b.order;
}

}  // namespace

// Collects the bodies without joints that jointed ones may hit. Returns true if they have changed.
bool BodyLinks::findFreeBodies(const std::vector<BodyState>& states) {
  m_new_free_bodies.clear();
  for (const BodyState& state : states) {
    if (state.solver == BodySolver::kJointImpacts && !isJoined(state.index))
      m_new_free_bodies.push_back(state.index);
  }
  if (m_new_free_bodies == m_free_bodies) return false;
  m_free_bodies.swap(m_new_free_bodies);
  return true;
}

void BodyLinks::stepImpacts(BodyTable& table, std::vector<BodyState>& states,
                            const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts) {
  m_is_moved.assign(m_solver.islands().size(), 0);
  for (std::size_t i = 0; i < candidates.size();) {
    std::size_t end = i + 1;
    while (end < candidates.size() && candidates[end].group == candidates[i].group) ++end;
    if (!stepImpactGroup(table, states, std::span(candidates).subspan(i, end - i), contacts)) {
      passToRigidWorld(candidates[i].group, table, states, contacts);
    }
    i = end;
  }
}

bool BodyLinks::stepImpactGroup(const BodyTable& table, std::vector<BodyState>& states,
                                std::span<const BodyCandidatePair> candidates, BodyContacts& contacts) {
  m_pairs.clear();
  for (const BodyCandidatePair& candidate : candidates) {
    const BodyState &a = states[at(candidate.a)], &b = states[at(candidate.b)];
    const BodyRow &row_a = table.row(a.index), &row_b = table.row(b.index);
    JointPair pair;
    pair.a = bodyAt(a.index), pair.b = bodyAt(b.index);
    if (pair.a < 0 || pair.b < 0) return false;
    pair.reach = a.radius + b.radius;
    pair.restitution = std::max(row_a.restitution, row_b.restitution);
    pair.friction = std::sqrt(row_a.friction * row_b.friction);
    m_pairs.push_back(pair);
  }
  if (!m_impacts.step(m_solver, m_bodies, m_joints, m_pairs, 1)) return false;
  for (const BodyCandidatePair& candidate : candidates) {  // pairs were searched only within reaches
    for (const int i : {candidate.a, candidate.b}) {
      const BodyState& state = states[at(i)];
      const Vec2 displacement = m_bodies[at(bodyAt(state.index))].place - state.start;
      const bool is_within = std::abs(displacement.x) + state.radius <= state.reach.x &&
                             std::abs(displacement.y) + state.radius <= state.reach.y;
      if (is_within) continue;
      m_impacts.undo(m_bodies);
      return false;
    }
  }
  for (const int island : m_impacts.islands()) m_is_moved[at(island)] = 1;
  for (const JointImpact& impact : m_impacts.impacts()) {
    BodyState& a = states[at(candidates[at(impact.pair)].a)];
    BodyState& b = states[at(candidates[at(impact.pair)].b)];
    a.contacts_changed = b.contacts_changed = true;
    const BodyState &first = isBefore(b, a) ? b : a, &second = isBefore(b, a) ? a : b;
    BodyContact contact = {impact.time,  first.key,      second.key, first.order,
                           second.order, impact.impulse, true,       BodySolver::kJointImpacts};
    contacts.add(contact);
    contact.is_begin = false;
    contacts.add(contact);
  }
  return true;
}

// Lets the RigidWorld move the group in this tick.
void BodyLinks::passToRigidWorld(int group, BodyTable& table, std::vector<BodyState>& states,
                                 BodyContacts& contacts) {
  for (BodyState& state : states) {
    if (state.solver != BodySolver::kJointImpacts || state.group != group) continue;
    state.solver = BodySolver::kRigid;
    const int body = bodyAt(state.index), island = body < 0 ? -1 : m_solver.islandOf(body);
    if (island >= 0) m_is_moved[at(island)] = 1;
    auto& last_solver = table.row(state.index).last_solver;
    if (last_solver == static_cast<std::uint8_t>(BodySolver::kRigid)) continue;
    last_solver = static_cast<std::uint8_t>(BodySolver::kRigid);
    contacts.handOver(state.key);
  }
}

}  // namespace naiad::physics
