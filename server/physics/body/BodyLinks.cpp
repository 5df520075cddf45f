#include "physics/body/BodyLinks.h"

#include <algorithm>
#include <utility>

#include "physics/geometry/Index.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

namespace {

// Maximum loops of a group. With this many, the search for an elimination order takes some milliseconds.
constexpr int kMaxLoops = 32;

}  // namespace

int BodyLinks::bodyOf(int row) {
  if (row != BodyJoints::kWorld && m_body_of[at(row)] >= 0) return m_body_of[at(row)];
  m_bodies.emplace_back();
  m_bodies.back().inverse_mass = 0;
  m_row_of.push_back(row);
  const int body = static_cast<int>(m_bodies.size()) - 1;
  if (row != BodyJoints::kWorld) m_body_of[at(row)] = body;
  return body;
}

// Collects the joined bodies that their own springs or stiff fields pull. Returns true if they have changed.
bool BodyLinks::findPulled(const std::vector<BodyState>& states) {
  m_new_pulled.clear();
  for (const BodyState& state : states) {
    if (state.solver == BodySolver::kJoints && state.isPulled()) m_new_pulled.push_back(state.index);
  }
  if (m_new_pulled == m_pulled) return false;
  m_pulled.swap(m_new_pulled);
  return true;
}

// Excludes the groups that may touch something, because other solvers move them.
void BodyLinks::leaveOut(BodyTable& table, const std::vector<BodyState>& states) {
  bool is_other = findFreeBodies(states);
  is_other = findPulled(states) || is_other;
  m_has_left_out = !m_free_bodies.empty() || !m_pulled.empty();
  m_is_rigid.resize(m_kinds.size(), 0);
  for (const BodyState& state : states) {
    if (!isJoined(state.index) || state.is_kinematic) continue;
    const std::uint8_t is_rigid = state.solver == BodySolver::kRigid || isSoft(state.solver) ? 1 : 0;
    is_other = is_other || m_is_rigid[state.index] != is_rigid;
    m_is_rigid[state.index] = is_rigid;
    m_has_left_out = m_has_left_out || is_rigid != 0;
  }
  if (!is_other) return;
  collect(table);
  m_is_connected = false;
}

void BodyLinks::prepare(BodyTable& table) {
  if (m_changes == table.joints.changes()) return;
  m_changes = table.joints.changes();
  m_is_rigid.clear();
  countLoops(table);
  collect(table);
  m_is_connected = false;
}

// Marks the bodies of groups with too many loops of joints. A tree of bodies is factored without fill-in, and
// each loop adds some. Several joints between the same two bodies are not a loop.
void BodyLinks::countLoops(const BodyTable& table) {
  m_is_costly.clear();
  if (table.joints.count() <= kMaxLoops) return;
  std::vector<std::pair<int, int>> edges;  // kWorld is the end of a joint that is fixed to the world
  const auto fixedOr = [&](int row) {
    return row == BodyJoints::kWorld || table.row(static_cast<BodyTable::Index>(row)).inverse_mass == 0
               ? BodyJoints::kWorld
               : row;
  };
  int rows = 0;
  for (const JointEntry& entry : table.joints.entries()) {
    if (!entry.used || entry.joint.kind == JointKind::kMouse) continue;
    const std::pair<int, int> edge = std::minmax(fixedOr(entry.joint.a), fixedOr(entry.joint.b));
    if (edge.second == BodyJoints::kWorld) continue;
    edges.push_back(edge);
    rows = std::max(rows, edge.second + 1);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<int> loops(at(rows), 0);
  std::vector<std::uint8_t> is_held(at(rows), 0);
  UnionFind sets;
  sets.reset(at(rows));
  for (const auto& [a, b] : edges) {
    const int root = sets.rootOf(b);
    if (a == BodyJoints::kWorld) {  // because all fixed ends of a group count as one body
      loops[at(root)] += is_held[at(root)];
      is_held[at(root)] = 1;
      continue;
    }
    const int other = sets.rootOf(a);
    if (other == root) {
      ++loops[at(root)];
      continue;
    }
    const int kept = std::min(root, other), merged = std::max(root, other);
    sets.unite(kept, merged);
    loops[at(kept)] += loops[at(merged)] + (is_held[at(kept)] & is_held[at(merged)]);
    is_held[at(kept)] |= is_held[at(merged)];
  }
  for (int row = 0; row < rows; ++row) {
    if (loops[at(sets.rootOf(row))] <= kMaxLoops) continue;
    m_is_costly.resize(at(rows), 0);
    m_is_costly[at(row)] = 1;
  }
}

void BodyLinks::collect(BodyTable& table) {
  const std::vector<JointEntry>& entries = table.joints.entries();
  std::size_t rows = 0;
  for (const JointEntry& entry : entries) {
    if (!entry.used) continue;
    for (const int row : {entry.joint.a, entry.joint.b}) rows = std::max(rows, at(row + 1));
  }
  m_kinds.assign(rows, kNoJoint);
  std::vector<int> joints_of(rows, 0);
  for (const JointEntry& entry : entries) {
    if (!entry.used) continue;
    for (const int row : {entry.joint.a, entry.joint.b}) {
      if (row != BodyJoints::kWorld) ++joints_of[at(row)], m_kinds[at(row)] = kJoined;
    }
  }
  m_bodies.clear();
  m_row_of.clear();
  m_body_of.assign(rows, -1);
  m_joints.clear();
  m_entry_of.clear();
  m_tunings.clear();
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const JointEntry& entry = entries[i];
    if (!entry.used) continue;
    const bool is_spring = entry.joint.kind == JointKind::kSpring && entry.joint.a == BodyJoints::kWorld;
    if (is_spring && joints_of[at(entry.joint.b)] == 1 && entry.joint.anchor_b == Vec2{}) {
      m_kinds[at(entry.joint.b)] = static_cast<int>(i);
      continue;
    }
    const auto isRigid = [&](int row) {
      return row >= 0 && at(row) < m_is_rigid.size() && m_is_rigid[at(row)] != 0;
    };
    if (isRigid(entry.joint.a) || isRigid(entry.joint.b)) continue;
    Joint joint = entry.joint;
    joint.a = bodyOf(entry.joint.a);
    joint.b = bodyOf(entry.joint.b);
    if (entry.joint.a == BodyJoints::kWorld) m_bodies[at(joint.a)].place = entry.anchor;
    if (entry.joint.b == BodyJoints::kWorld) m_bodies[at(joint.b)].place = entry.anchor;
    m_joints.push_back(joint);
    m_entry_of.push_back(i);
    m_tunings.push_back(entry.tunings);
  }
  for (const BodyTable::Index pulled : m_pulled) {
    if (pulled >= m_body_of.size() || m_body_of[pulled] < 0) continue;
    m_joints.push_back(jointOf({}, 1));
    m_joints.back().b = m_body_of[pulled];
    m_entry_of.push_back(kPull);
    m_tunings.push_back(0);
  }
  for (const BodyTable::Index free_body : m_free_bodies) {
    if (free_body >= m_body_of.size()) m_body_of.resize(free_body + 1, -1);
    bodyOf(static_cast<int>(free_body));
  }
}

// Copies the states to m_bodies. Inactive bodies become static; bodies joined to them stay attached.
void BodyLinks::load(const BodyTable& table, const std::vector<BodyState>& states,
                     const std::vector<double>& unit_inertias) {
  m_state_of.assign(m_bodies.size(), -1);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int body = bodyAt(states[i].index);
    if (body >= 0) m_state_of[at(body)] = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (m_row_of[i] == BodyJoints::kWorld) continue;
    JointBody& body = m_bodies[i];
    const auto index = static_cast<BodyTable::Index>(m_row_of[i]);
    const BodyRow& row = table.row(index);
    const BodyGeometry& form = table.form(index);
    JointBody next;
    next.place = row.place;
    next.rotation = form.rotation;
    next.inverse_mass = 0;
    if (m_state_of[i] >= 0) {
      const BodyState& state = states[at(m_state_of[i])];
      const double unit_inertia = unit_inertias[at(m_state_of[i])];
      next.velocity = row.velocity;
      next.spin = form.spin;
      next.inverse_mass = row.inverse_mass;
      next.inverse_inertia = unit_inertia > 0 ? row.inverse_mass / unit_inertia : 0;
      next.force = row.mass * state.push;
      next.torque = form.torque;
      if (!isValid(next)) {
        next = {};
        next.place = row.place;
        next.inverse_mass = 0;
      }
    }
    const bool is_other =
        next.inverse_mass != body.inverse_mass || next.inverse_inertia != body.inverse_inertia;
    if (is_other) m_is_connected = false;
    body = next;
  }
}

void BodyLinks::step(BodyTable& table, std::vector<BodyState>& states,
                     const std::vector<double>& unit_inertias,
                     const std::vector<BodyCandidatePair>& candidates, BodyContacts& contacts) {
  load(table, states, unit_inertias);
  std::vector<JointEntry>& entries = table.joints.entries();
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    if (m_entry_of[i] == kPull) {
      const int state = m_state_of[at(m_joints[i].b)];
      const BodyState* p_state = state >= 0 ? &states[at(state)] : nullptr;
      const Pull pull = p_state != nullptr && p_state->isPulled() ? p_state->pull : Pull{};
      const Joint now = jointOf(pull, p_state != nullptr ? table.row(p_state->index).mass : 1);
      m_joints[i].target = now.target;
      m_joints[i].stiffness = now.stiffness;
      m_joints[i].damping = now.damping;
      continue;
    }
    JointEntry& entry = entries[m_entry_of[i]];
    if (std::exchange(m_tunings[i], entry.tunings) == entry.tunings) continue;
    Joint joint = entry.joint;
    joint.a = m_joints[i].a;
    joint.b = m_joints[i].b;
    joint.memory = m_joints[i].memory;
    m_joints[i] = joint;
  }
  if (!m_is_connected) m_is_connected = m_solver.connect(m_bodies, m_joints) == 0;
  m_is_moved.clear();
  if (m_is_connected && !candidates.empty()) stepImpacts(table, states, candidates, contacts);
  if (m_is_connected) m_solver.step(m_bodies, m_joints, 1, {}, {}, m_is_moved);
  store(table, states);
}

void BodyLinks::store(BodyTable& table, std::vector<BodyState>& states) {
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (m_state_of[i] < 0) continue;
    BodyState& state = states[at(m_state_of[i])];
    if (state.solver != BodySolver::kJoints && state.solver != BodySolver::kJointImpacts) continue;
    const JointBody& body = m_bodies[i];
    state.place = body.place;
    state.velocity = body.velocity;
    state.rotation = body.rotation;
    state.spin = body.spin;
    state.acceleration = state.contacts_changed ? Vec2{} : body.velocity - state.start_velocity;
    const bool is_held = body.inverse_mass == 0 && table.row(state.index).inverse_mass > 0;
    if (is_held || !m_is_connected)
      state.p_failure = "its position, velocity, mass or force is out of range for joints";
  }
  for (const JointIsland& island : m_solver.islands()) {
    if (!island.isFrozen()) continue;
    for (const int body : island.bodies()) {
      if (m_state_of[at(body)] < 0) continue;
      states[at(m_state_of[at(body)])].p_failure = "the bodies joined to it cannot be computed";
    }
  }
  std::vector<JointEntry>& entries = table.joints.entries();
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    if (m_entry_of[i] == kPull) continue;
    JointEntry& entry = entries[m_entry_of[i]];
    entry.joint.force = m_joints[i].force;
    entry.joint.torque = m_joints[i].torque;
    entry.joint.memory = m_joints[i].memory;  // first guess for the joints that the next collect() makes
    if (m_joints[i].is_broken) table.joints.remove({m_entry_of[i], entry.generation});
  }
}

}  // namespace naiad::physics
