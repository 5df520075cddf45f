#include "physics/body/BodyRigids.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// Returns the change per tick of the acceleration of a path that starts at `velocity` and has the end and
// final velocity of the flight. Returns 0 if the flight differs much from this path, because a body that
// brakes within a part of the tick would be thrown back.
Vec2 jerkOf(const Flown& flown, Vec2 velocity) {
  constexpr double kRounding = 1e-14, kSteady = 0.25;  // both as a part of the speeds
  const Vec2 gain = flown.velocity - velocity;
  const Vec2 missing = velocity + 0.5 * gain - flown.displacement;
  const double speed = length(velocity) + length(gain);
  return length(missing) > kRounding * speed && length(missing) < kSteady * speed ? 12 * missing : Vec2{};
}

}  // namespace

bool BodyRigids::isStepped(const BodyState& state) const {
  return state.solver == m_solver ||
         (m_solver == BodySolver::kRigid ? state.is_near_rigid : state.is_near_substep);
}

int BodyRigids::rigidOf(int row) const {
  if (row < 0 || row >= static_cast<int>(m_proxies.size())) return -1;
  return m_proxies[at(row)].is_used ? m_proxies[at(row)].id : -1;
}

bool BodyRigids::isGivenUp(const BodyTable& table, BodyTable::Index row) const {
  const int id = rigidOf(static_cast<int>(row));
  return id >= 0 && m_proxies[row].order == table.row(row).order && m_world.isGivenUp(id);
}

void BodyRigids::identify(int id, ObjectKey key, std::uint64_t order, int state) {
  if (id >= static_cast<int>(m_identities.size())) m_identities.resize(at(id) + 1);
  m_identities[at(id)] = {key, order, state};
}

// Adds the body to the solver, or updates its shapes there. Only HARD bodies that may be touched have shapes
// there.
void BodyRigids::shape(Proxy& proxy, const BodyTable& table, const BodyState& state, const FixedBox& box,
                       const RigidBody& body) {
  const BodyGeometry& form = table.form(state.index);
  const bool is_box = form.shapes.empty();
  const bool has_shapes = state.is_hard && !state.is_alone;
  const std::uint32_t version = has_shapes ? form.version + 1 : 0;
  if (proxy.id >= 0 && proxy.version == version && (!is_box || proxy.box == box)) return;
  std::span<const ConvexShape> shapes;
  ConvexShape made;
  if (has_shapes && !is_box) shapes = form.shapes;
  if (has_shapes && is_box) {
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    const Vec2 centre = table.metric.fromCells(Vector::fromFixed(box.corner)) + half;
    if (makeBox(half.x, half.y, centre, {}, 0, made) == ShapeStatus::kOk) shapes = {&made, 1};
  }
  proxy.version = version;
  proxy.box = box;
  if (proxy.id < 0) {
    proxy.id = m_world.addInOrder(state.order, body, shapes);
  } else {
    m_world.setShapes(proxy.id, shapes);
  }
}

void BodyRigids::updateBodies(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states,
                              const std::vector<double>& unit_inertias, const BodyContacts& contacts) {
  for (Proxy& proxy : m_proxies) proxy.is_used = false;
  for (const BodyState& state : states) {
    if (!isStepped(state)) continue;
    if (state.index >= m_proxies.size()) m_proxies.resize(state.index + 1);
    Proxy& proxy = m_proxies[state.index];
    const std::uint64_t order = table.row(state.index).order;
    if (proxy.id >= 0 && proxy.order != order) {  // the entry belongs to a deleted body of this row
      m_world.remove(proxy.id);
      proxy.id = -1;
    }
    proxy.order = order;
    proxy.is_used = true;
  }
  for (Proxy& proxy : m_proxies) {
    if (proxy.is_used || proxy.id < 0) continue;
    m_world.remove(proxy.id);
    proxy.id = -1;
  }
  m_count = 0;
  m_has_pulls = false;
  m_fastest = {};
  m_world.expect(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    BodyState& state = states[i];
    if (!isStepped(state)) continue;
    if (state.solver == m_solver) {
      state.is_touched = contacts.isTouching(state.key);
      m_has_pulls = m_has_pulls || state.isPulled();
      m_fastest = {std::max(m_fastest.x, std::fabs(state.start_velocity.x)),
                   std::max(m_fastest.y, std::fabs(state.start_velocity.y))};
    }
    const BodyRow& row = table.row(state.index);
    const BodyGeometry& form = table.form(state.index);
    RigidBody body;
    body.place = row.place;
    body.velocity = row.velocity;
    body.rotation = form.rotation;
    body.spin = form.spin;
    body.inverse_mass = row.inverse_mass;
    body.inverse_inertia = unit_inertias[i] > 0 ? row.inverse_mass / unit_inertias[i] : 0;
    body.acceleration = state.is_kinematic ? Vec2{} : state.push;
    if (!state.is_kinematic && state.is_bent && !state.is_sprung && state.turn_rate == 0) {
      body.acceleration = state.flown.velocity - row.velocity;
      if (row.flight == FlightKind::kField) body.jerk = jerkOf(state.flown, row.velocity);
    }
    body.turn_rate = state.turn_rate;
    body.torque = form.torque;
    body.friction = row.friction;
    body.restitution = row.restitution;
    Proxy& proxy = m_proxies[state.index];
    shape(proxy, table, state, store.box(state.key.slot), body);
    if (proxy.id < 0) continue;
    m_world.set(proxy.id, body);
    identify(proxy.id, state.key, state.order, static_cast<int>(i));
    ++m_count;
  }
}

// Updates the obstacles near the bodies. A body that is hit may get as far as the fastest body (m_fastest).
void BodyRigids::updateObstacles(const WorldStore& store, const BodyTable& table,
                                 const std::vector<BodyState>& states, BodyContacts& contacts) {
  m_obstacles.beginTick();
  m_surroundings.clear();
  for (const BodyState& state : states) {
    if (state.solver != m_solver || !state.is_hard || state.is_alone) continue;
    m_surroundings.addRegion(regionOf(table.metric, state.start, state.reach + m_fastest));
  }
  m_surroundings.query(store, [&](std::size_t /*number*/, ObjectKey key) {
    if (BodyObstacles::isObstacle(store, key)) m_obstacles.markNear(key);
  });
  for (BodyObstacles::Obstacle& obstacle : m_obstacles.all()) {
    if (!obstacle.is_near) {
      if (obstacle.id >= 0) m_world.remove(obstacle.id);
      contacts.expire(obstacle.key, m_solver);
      continue;
    }
    const std::uint32_t slot = obstacle.key.slot;
    const FixedBox box = store.box(slot);
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    RigidBody body;
    body.place = table.metric.placeOf(store.position(slot) + box.corner) + half;
    body.inverse_mass = 0;
    body.friction = table.settings.obstacle_friction;
    body.restitution = table.settings.obstacle_restitution;
    const bool is_known = obstacle.id >= 0;
    if (is_known && m_obstacle_boxes[at(obstacle.id)].size == box.size) {
      m_world.set(obstacle.id, body);
    } else {
      if (is_known) m_world.remove(obstacle.id);
      obstacle.id = -1;
      ConvexShape made;
      if (makeBox(half.x, half.y, {}, {}, 0, made) != ShapeStatus::kOk) continue;
      obstacle.id = m_world.addInOrder(store.order(slot), body, std::span(&made, 1));
      if (obstacle.id < 0) continue;
      if (at(obstacle.id) >= m_obstacle_boxes.size()) m_obstacle_boxes.resize(at(obstacle.id) + 1);
      m_obstacle_boxes[at(obstacle.id)] = box;
    }
    identify(obstacle.id, obstacle.key, store.order(slot), -1);
  }
  m_obstacles.removeFar();
}

// True if this solver moves a body of the joint. A joint's other body may be inactive, and then does not
// move.
bool BodyRigids::isHere(const JointEntry& entry) const {
  return entry.used && (rigidOf(entry.joint.a) >= 0 || rigidOf(entry.joint.b) >= 0);
}

// True if the joint in the solver has the bodies that the entry's joint has now.
bool BodyRigids::isKnown(const JointProxy& proxy, const JointEntry& entry) const {
  const auto isEnd = [&](int row, int id) {
    const int here = rigidOf(row);
    return here >= 0 ? here == id : proxy.anchor == id && proxy.anchored == row;
  };
  return proxy.generation == entry.generation && m_world.jointExists(proxy.id) &&
         isEnd(entry.joint.a, proxy.a) && isEnd(entry.joint.b, proxy.b);
}

// Returns the solver's body for an end of a joint. Adds one for the world or an inactive body.
int BodyRigids::anchorOf(JointProxy& proxy, const BodyTable& table, const JointEntry& entry, int row) {
  const int here = rigidOf(row);
  if (here >= 0) return here;
  RigidBody anchor;
  anchor.inverse_mass = 0;
  anchor.place = entry.anchor;
  if (row != BodyJoints::kWorld) {
    anchor.place = table.row(static_cast<BodyTable::Index>(row)).place;
    anchor.rotation = table.form(static_cast<BodyTable::Index>(row)).rotation;
  }
  proxy.anchored = row;
  if (proxy.anchor < 0) {
    proxy.anchor = m_world.addInOrder(0, anchor, {});
  } else {
    m_world.set(proxy.anchor, anchor);
  }
  return proxy.anchor;
}

// Removes joints that are gone or have no body any more. Call before joints are added, as ids are reused.
void BodyRigids::removeJoints(const BodyTable& table, const std::vector<BodyState>& states) {
  const std::vector<JointEntry>& entries = table.joints.entries();
  for (std::size_t i = 0; i < m_joint_proxies.size(); ++i) {
    JointProxy& proxy = m_joint_proxies[i];
    if (proxy.id < 0) continue;
    if (isHere(entries[i]) && isKnown(proxy, entries[i])) continue;
    m_world.removeJoint(proxy.id);
    if (proxy.anchor >= 0) m_world.remove(proxy.anchor);
    proxy = {};
  }
  if (m_pull_proxies.empty()) return;
  for (PullProxy& proxy : m_pull_proxies) proxy.is_used = false;
  for (const BodyState& state : states) {
    if (!isPulledHere(state) || state.index >= m_pull_proxies.size()) continue;
    PullProxy& proxy = m_pull_proxies[state.index];
    proxy.is_used = proxy.order == table.row(state.index).order && m_world.jointExists(proxy.id);
  }
  for (PullProxy& proxy : m_pull_proxies) {
    if (proxy.is_used || proxy.id < 0) continue;
    m_world.removeJoint(proxy.id);
    proxy = {};
  }
}

void BodyRigids::updateJoints(const BodyTable& table) {
  const std::vector<JointEntry>& entries = table.joints.entries();
  if (m_joint_proxies.size() < entries.size()) m_joint_proxies.resize(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const JointEntry& entry = entries[i];
    if (!isHere(entry)) continue;
    JointProxy& proxy = m_joint_proxies[i];
    Joint joint = entry.joint;
    const bool is_inactive = proxy.anchor >= 0 && proxy.anchored != BodyJoints::kWorld;
    if (proxy.id < 0 || is_inactive) {
      proxy.a = anchorOf(proxy, table, entry, joint.a);
      proxy.b = anchorOf(proxy, table, entry, joint.b);
    }
    joint.a = proxy.a;
    joint.b = proxy.b;
    if (proxy.id < 0) {
      proxy.id = m_world.addJoint(joint, false);
    } else if (proxy.tunings != entry.tunings) {
      m_world.setJoint(proxy.id, joint);
    }
    proxy.generation = entry.generation;
    proxy.tunings = entry.tunings;
  }
}

bool BodyRigids::isPulledHere(const BodyState& state) const {
  return state.solver == m_solver && state.isPulled() && rigidOf(static_cast<int>(state.index)) >= 0;
}

// Updates the joints that represent pulls. A pull is a spring to a point of the world.
void BodyRigids::updatePulls(const BodyTable& table, const std::vector<BodyState>& states) {
  for (const BodyState& state : states) {
    if (!isPulledHere(state)) continue;
    if (state.index >= m_pull_proxies.size()) m_pull_proxies.resize(state.index + 1);
    PullProxy& proxy = m_pull_proxies[state.index];
    const BodyRow& row = table.row(state.index);
    if (proxy.id >= 0 && proxy.pull == state.pull && proxy.mass == row.mass) continue;
    Joint joint = jointOf(state.pull, row.mass);
    joint.b = rigidOf(static_cast<int>(state.index));
    if (proxy.id < 0) {
      proxy.id = m_world.addJoint(joint, true);
    } else {
      m_world.setJoint(proxy.id, joint);
    }
    proxy.order = row.order;
    proxy.pull = state.pull;
    proxy.mass = row.mass;
  }
}

void BodyRigids::step(const WorldStore& store, BodyTable& table, std::vector<BodyState>& states,
                      const std::vector<double>& unit_inertias, BodyContacts& contacts) {
  if (std::exchange(m_may_sleep, table.settings.may_sleep) != table.settings.may_sleep)
    m_world.setSleeping(table.settings.may_sleep);
  updateBodies(store, table, states, unit_inertias, contacts);
  updateObstacles(store, table, states, contacts);
  removeJoints(table, states);
  updateJoints(table);
  if (m_has_pulls) updatePulls(table, states);
  if (m_count == 0) return;
  m_world.step();
  collect(states, contacts);
  finish(table, states, contacts);
}

void BodyRigids::collect(std::vector<BodyState>& states, BodyContacts& contacts) const {
  contacts.expect(m_world.events().size());
  for (const RigidEvent& event : m_world.events()) {
    const Identity* p_first = &m_identities[at(event.first)];
    const Identity* p_second = &m_identities[at(event.second)];
    for (const Identity* p_identity : {p_first, p_second}) {
      if (p_identity->state >= 0)
        states[at(p_identity->state)].is_touched = states[at(p_identity->state)].contacts_changed = true;
    }
    const bool is_swapped = p_first->state < 0 || (p_second->state >= 0 && p_second->order < p_first->order);
    if (is_swapped) std::swap(p_first, p_second);
    contacts.add({event.time, p_first->key, p_second->key, p_first->order, p_second->order, event.impulse,
                  event.is_begin, m_solver});
  }
}

void BodyRigids::finish(BodyTable& table, std::vector<BodyState>& states, const BodyContacts& contacts) {
  for (BodyState& state : states) {
    if (state.solver != m_solver) continue;
    const Proxy& proxy = m_proxies[state.index];
    if (proxy.id < 0) {
      state.p_failure = "its values are out of range";
      continue;
    }
    if (m_world.isFrozen(proxy.id)) state.p_failure = "its motion cannot be computed";
    const RigidBody& body = m_world.body(proxy.id);
    const Vec2 pushed = body.velocity - (state.start_velocity + body.acceleration);
    const double rounding = 1e-9 * (length(state.start_velocity) + length(body.acceleration));
    const bool is_touched =
        state.is_touched || state.is_joined || state.must_be_held || contacts.isTouching(state.key);
    const bool is_alone =
        isSoft(m_solver) ? !m_world.isStopped(proxy.id) : state.turn_rate != 0 || length(pushed) <= rounding;
    if (!is_touched && is_alone) {  // then the flight alone gives the exact result
      state.place = state.start + state.flown.displacement;
      state.velocity = state.flown.velocity;
      continue;
    }
    state.turns_alone = false;
    state.place = body.place;
    state.velocity = body.velocity;
    state.rotation = body.rotation;
    state.spin = body.spin;
    const bool is_still = body.velocity == Vec2{} && body.spin == 0;
    if (is_still) {
      state.acceleration = {};
    } else if (!state.contacts_changed) {
      state.acceleration = body.velocity - state.start_velocity;
    }
  }
  const std::vector<JointEntry>& entries = std::as_const(table).joints.entries();
  for (std::size_t i = 0; i < m_joint_proxies.size() && i < entries.size(); ++i) {
    const JointProxy& proxy = m_joint_proxies[i];
    if (proxy.id < 0 || !entries[i].used || entries[i].generation != proxy.generation) continue;
    const Joint& joint = m_world.joint(proxy.id);
    JointEntry& entry = table.joints.entries()[i];
    entry.joint.force = joint.force;
    entry.joint.torque = joint.torque;
    if (joint.is_broken) table.joints.remove({static_cast<std::uint32_t>(i), proxy.generation});
  }
}

}  // namespace naiad::physics
