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

// An Object's order in the solver is a multiple of its order in the world. The numbers between are those of
// the blocks found from its sides.
constexpr std::uint64_t kOrders = 8;
constexpr double kSlow = 1;  // metric cells per tick: obstacles at this distance are always near
std::uint64_t orderOf(std::uint64_t order, int side) {
  return kOrders * order + 1 + at(side);
}

// Makes the shape of a body that has its Object's box. Returns false if the box is too small or too large.
bool boxShapeOf(const Metric& metric, const FixedBox& box, ConvexShape& made) {
  const Vec2 half = 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  const Vec2 centre = metric.fromCells(Vector::fromFixed(box.corner)) + half;
  return makeBox(half.x, half.y, centre, {}, 0, made) == ShapeStatus::kOk;
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

void BodyRigids::identify(int id, const Identity& identity) {
  if (id >= static_cast<int>(m_identities.size())) m_identities.resize(at(id) + 1);
  m_identities[at(id)] = identity;
}

// Adds the body to the solver, or updates its shapes there. Only HARD bodies have shapes there.
void BodyRigids::shape(Proxy& proxy, const BodyTable& table, const BodyState& state, const FixedBox& box,
                       const RigidBody& body) {
  const BodyGeometry& form = table.form(state.index);
  const bool is_box = form.shapes.empty();
  const bool has_shape = state.is_hard && !state.is_merged;
  const std::uint32_t version = has_shape ? form.version + 1 : 0;
  if (proxy.id >= 0 && proxy.version == version && (!is_box || proxy.box == box)) return;
  std::span<const ConvexShape> shapes;
  ConvexShape made;
  if (has_shape && !is_box) shapes = form.shapes;
  if (has_shape && is_box && boxShapeOf(table.metric, box, made)) shapes = {&made, 1};
  proxy.version = version;
  proxy.box = box;
  if (proxy.id < 0) {
    proxy.id = m_world.addInOrder(kOrders * state.order, body, shapes);
  } else {
    m_world.setShapes(proxy.id, shapes);
  }
}

// Removes a body from the solver. Its contacts end, unless they were handed over to another solver.
void BodyRigids::remove(Proxy& proxy, BodyContacts& contacts) {
  contacts.expire(m_identities[at(proxy.id)].key, m_solver);
  m_world.remove(proxy.id);
  proxy.id = -1;
}

void BodyRigids::updateBodies(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states,
                              const std::vector<double>& unit_inertias, BodyContacts& contacts) {
  for (Proxy& proxy : m_proxies) proxy.is_used = false;
  for (const BodyState& state : states) {
    if (!isStepped(state)) continue;
    if (state.index >= m_proxies.size()) m_proxies.resize(state.index + 1);
    Proxy& proxy = m_proxies[state.index];
    const std::uint64_t order = table.row(state.index).order;
    if (proxy.id >= 0 && proxy.order != order) remove(proxy, contacts);  // it is that of a deleted body
    proxy.order = order;
    proxy.is_used = true;
  }
  for (Proxy& proxy : m_proxies) {
    if (!proxy.is_used && proxy.id >= 0) remove(proxy, contacts);
  }
  m_count = 0;
  m_has_pulls = false;
  m_world.expect(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    BodyState& state = states[i];
    if (!isStepped(state)) continue;
    if (state.solver == m_solver) m_has_pulls = m_has_pulls || state.isPulled();
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
    identify(proxy.id, {state.key, state.order, static_cast<int>(i)});
    ++m_count;
  }
}

// Finds the stretches: a body that is hit may get as far as the fastest body of its own. A distant group has
// no effect on it, because which obstacles are near decides how far a block reaches.
void BodyRigids::findStretches(const std::vector<BodyState>& states) {
  m_stretches.clear();
  bool are_slow = true;
  for (const BodyState& state : states) {
    if (state.solver != m_solver) continue;
    const double tip = std::fabs(state.spin) * state.size.x;  // a rotating bar throws what it hits, or itself
    const Vec2 fastest = {std::max(kSlow, std::fabs(state.start_velocity.x) + tip),
                          std::max(kSlow, std::fabs(state.start_velocity.y) + tip)};
    are_slow = are_slow && fastest == Vec2{kSlow, kSlow};
    const double x = (state.start - Place{}).x, reach = state.reach.x;
    m_stretches.push_back({x - reach, x + reach, fastest});
  }
  if (are_slow) return m_stretches.clear();
  std::sort(m_stretches.begin(), m_stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.low < b.low; });
  for (std::size_t before = 0; before != m_stretches.size();) {
    before = m_stretches.size();
    std::size_t last = 0;
    for (std::size_t i = 1; i < before; ++i) {
      const Stretch next = m_stretches[i];
      Stretch& its = m_stretches[last];
      if (next.low - next.fastest.x > its.high + its.fastest.x) {
        m_stretches[++last] = next;
        continue;
      }
      its.high = std::max(its.high, next.high);
      its.fastest = {std::max(its.fastest.x, next.fastest.x), std::max(its.fastest.y, next.fastest.y)};
    }
    m_stretches.resize(last + 1);
  }
}

Vec2 BodyRigids::fastestNear(const Place& place) const {
  if (m_stretches.empty()) return {kSlow, kSlow};
  const auto after = std::upper_bound(m_stretches.begin(), m_stretches.end(), (place - Place{}).x,
                                      [](double x, const Stretch& its) { return x < its.low; });
  return after == m_stretches.begin() ? after->fastest : std::prev(after)->fastest;
}

// Updates the obstacles near the bodies.
void BodyRigids::updateObstacles(const WorldStore& store, const BodyTable& table,
                                 const std::vector<BodyState>& states, BodyContacts& contacts) {
  findStretches(states);
  m_obstacles.beginTick();
  m_surroundings.clear();
  for (const BodyState& state : states) {
    if (state.solver != m_solver || !state.is_hard) continue;
    m_surroundings.addRegion(regionOf(table.metric, state.start, state.reach + fastestNear(state.start)));
  }
  m_surroundings.query(store, [&](std::size_t /*number*/, ObjectKey key) {
    if (BodyObstacles::isObstacle(store, key)) m_obstacles.markNear(key);
  });
  m_obstacles.update(store);
  for (const ObjectKey key : m_obstacles.farObjects()) contacts.expire(key, m_solver);
  for (const int id : m_obstacles.removedIds()) m_world.remove(id);
  std::vector<BodyObstacles::Block>& blocks = m_obstacles.blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    BodyObstacles::Block& block = blocks[i];
    const FixedBox box = block.shape.area.box();
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    RigidBody body;
    body.place = table.metric.placeOf(box.corner) + half;
    body.inverse_mass = 0;
    body.friction = table.settings.obstacle_friction;
    body.restitution = table.settings.obstacle_restitution;
    const std::uint64_t order = store.order(block.key.slot);
    const bool is_known = block.id >= 0;
    if (!is_known || block.size != box.size) {
      ConvexShape made;
      const bool is_sound = makeBox(half.x, half.y, {}, {}, 0, made) == ShapeStatus::kOk;
      const std::span<const ConvexShape> shapes(&made, is_sound ? 1 : 0);
      if (is_known) {
        m_world.setShapes(block.id, shapes);
      } else {
        block.id = m_world.addInOrder(orderOf(order, block.side), body, shapes);
      }
      if (block.id < 0) continue;
      block.size = box.size;
    }
    if (is_known) m_world.set(block.id, body);
    identify(block.id, {block.key, order, -1, static_cast<int>(i)});
  }
}

// Gives a platform the frictions of its bodies, if they differ.
void BodyRigids::setFrictions(const Metric& metric, const BodyPlatforms::Platform& platform,
                              std::span<const BlockContacts::Member> members, int id) {
  m_friction_parts.clear();
  bool is_mixed = false;
  const FixedBox box = platform.shape.area.box();
  const Vec2 middle =
      metric.fromCells(Vector::fromFixed(box.corner)) + 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  for (const BlockContacts::Member& member : members) {
    if (!BodyPlatforms::hasPart(platform, member)) continue;
    const FixedBox own = member.area.box();
    const Vec2 low = metric.fromCells(Vector::fromFixed(own.corner)) - middle;
    m_friction_parts.push_back({{low, low + metric.fromCells(Vector::fromFixed(own.size))}, member.friction});
    is_mixed = is_mixed || member.friction != m_friction_parts[0].friction;
  }
  if (!is_mixed) m_friction_parts.clear();
  m_world.setFrictionParts(id, m_friction_parts);
}

// Updates the platforms of which a body is near.
void BodyRigids::updatePlatforms(const BodyTable& table, const BodyPlatforms& platforms,
                                 const std::vector<BodyState>& states) {
  for (PlatformProxy& proxy : m_platform_proxies) proxy.is_used = false;
  const std::vector<BodyPlatforms::Platform>& all = platforms.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const BodyPlatforms::Platform& platform = all[i];
    const auto members = platforms.members(platform);
    bool is_near = false;
    for (std::size_t k = 0; k < members.size() && !is_near; ++k) {
      is_near = isStepped(states[at(platforms.stateOf(platform, static_cast<int>(k)))]) &&
                BodyPlatforms::hasPart(platform, members[k]);
    }
    if (!is_near) continue;
    const BodyRow& row = table.row(states[at(platforms.stateOf(platform, 0))].index);
    const FixedBox box = platform.shape.area.box();
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    RigidBody body;
    body.place = row.place + (table.metric.fromCells(Vector::fromFixed(box.corner)) + half);
    body.velocity = row.velocity;
    body.inverse_mass = 0;
    body.friction = row.friction;
    body.restitution = row.restitution;
    auto proxy = std::find_if(m_platform_proxies.begin(), m_platform_proxies.end(),
                              [&](const PlatformProxy& p) { return p.serial == platform.serial; });
    if (proxy == m_platform_proxies.end()) {
      ConvexShape made;
      if (makeBox(half.x, half.y, {}, {}, 0, made) != ShapeStatus::kOk) continue;
      const int id = m_world.addInOrder(orderOf(platform.order, platform.side), body, std::span(&made, 1));
      if (id < 0) continue;
      proxy = m_platform_proxies.insert(proxy, {platform.serial, id});
      setFrictions(table.metric, platform, members, id);
    }
    proxy->is_used = true;
    m_world.set(proxy->id, body);
    identify(proxy->id, {members[0].key, members[0].order, -1, static_cast<int>(i), true});
  }
  for (const PlatformProxy& proxy : m_platform_proxies) {
    if (proxy.is_used) continue;
    m_world.setFrictionParts(proxy.id, {});
    m_world.remove(proxy.id);
  }
  std::erase_if(m_platform_proxies, [](const PlatformProxy& proxy) { return !proxy.is_used; });
}

// True if this solver moves all bodies of the joint.
bool BodyRigids::isHere(const JointEntry& entry) const {
  const auto isEndHere = [&](int row) { return row == BodyJoints::kWorld || rigidOf(row) >= 0; };
  return entry.used && isEndHere(entry.joint.a) && isEndHere(entry.joint.b);
}

// Removes joints that are gone or have no body any more. Call before joints are added, as ids are reused.
void BodyRigids::removeJoints(const BodyTable& table, const std::vector<BodyState>& states) {
  const std::vector<JointEntry>& entries = table.joints.entries();
  for (std::size_t i = 0; i < m_joint_proxies.size(); ++i) {
    JointProxy& proxy = m_joint_proxies[i];
    if (proxy.id < 0) continue;
    if (isHere(entries[i]) && proxy.generation == entries[i].generation && m_world.jointExists(proxy.id))
      continue;
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
    const bool is_world_a = entry.joint.a == BodyJoints::kWorld;
    const bool is_world_b = entry.joint.b == BodyJoints::kWorld;
    Joint joint = entry.joint;
    if (proxy.id < 0 && (is_world_a || is_world_b)) {
      RigidBody anchor;
      anchor.place = entry.anchor;
      anchor.inverse_mass = 0;
      proxy.anchor = m_world.addInOrder(0, anchor, {});
    }
    joint.a = is_world_a ? proxy.anchor : rigidOf(entry.joint.a);
    joint.b = is_world_b ? proxy.anchor : rigidOf(entry.joint.b);
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

void BodyRigids::step(const WorldStore& store, BodyTable& table, const BodyPlatforms& platforms,
                      std::vector<BodyState>& states, const std::vector<double>& unit_inertias,
                      BodyContacts& contacts) {
  if (std::exchange(m_may_sleep, table.settings.may_sleep) != table.settings.may_sleep)
    m_world.setSleeping(table.settings.may_sleep);
  updateBodies(store, table, states, unit_inertias, contacts);
  updateObstacles(store, table, states, contacts);
  if (!platforms.isEmpty() || !m_platform_proxies.empty()) updatePlatforms(table, platforms, states);
  removeJoints(table, states);
  updateJoints(table);
  if (m_has_pulls) updatePulls(table, states);
  if (m_count == 0) return;
  m_world.step();
  collect(store, table, platforms, states, contacts);
  finish(table, states);
}

void BodyRigids::collect(const WorldStore& store, const BodyTable& table, const BodyPlatforms& platforms,
                         std::vector<BodyState>& states, BodyContacts& contacts) {
  contacts.expect(m_world.events().size());
  for (const RigidEvent& event : m_world.events()) {
    const Identity* p_first = &m_identities[at(event.first)];
    const Identity* p_second = &m_identities[at(event.second)];
    for (const Identity* p_identity : {p_first, p_second}) {
      if (p_identity->state >= 0) states[at(p_identity->state)].contacts_changed = true;
    }
    const bool is_swapped = p_first->state < 0 || (p_second->state >= 0 && p_second->order < p_first->order);
    if (is_swapped) std::swap(p_first, p_second);
    const BodyContact contact = {event.time,      p_first->key,  p_second->key,  p_first->order,
                                 p_second->order, event.impulse, event.is_begin, m_solver};
    const bool is_one = p_second->block < 0 ||
                        (!p_second->is_platform && m_obstacles.blocks()[at(p_second->block)].is_whole_object);
    if (is_one) {
      contacts.add(contact);
    } else {
      m_block_contacts.add(contact, is_swapped ? event.second : event.first,
                           is_swapped ? event.first : event.second);
    }
  }
  if (!m_block_contacts.isEmpty()) settleBlocks(store, table, platforms, states, contacts);
}

void BodyRigids::settleBlocks(const WorldStore& store, const BodyTable& table, const BodyPlatforms& platforms,
                              const std::vector<BodyState>& states, BodyContacts& contacts) {
  ConvexShape made;
  const auto moverOf = [&](int id) {
    BlockContacts::Mover mover;
    const int index = m_world.exists(id) ? m_identities[at(id)].state : -1;
    if (index < 0 || states[at(index)].solver != m_solver) return mover;
    const BodyState& state = states[at(index)];
    const BodyGeometry& form = table.form(state.index);
    mover.key = state.key;
    mover.shapes = form.shapes;
    if (form.shapes.empty() && boxShapeOf(table.metric, store.box(state.key.slot), made))
      mover.shapes = {&made, 1};
    const RigidBody& body = m_world.body(id);
    mover.start = {state.start, form.rotation};
    mover.end = {body.place, body.rotation};
    mover.velocity = state.start_velocity;
    return mover;
  };
  const auto viewOf = [&](int id) {
    BlockContacts::View view;
    const Identity its = m_world.exists(id) ? m_identities[at(id)] : Identity{};
    if (its.block < 0) return view;
    if (!its.is_platform) {
      view.p_shape = &m_obstacles.blocks()[at(its.block)].shape;
      return view;
    }
    const BodyPlatforms::Platform& platform = platforms.all()[at(its.block)];
    const BodyState& front = states[at(platforms.stateOf(platform, 0))];
    view.p_shape = &platform.shape;
    view.members = platforms.members(platform);
    view.base = front.place;
    view.velocity = front.velocity;
    return view;
  };
  m_block_contacts.settle(store, table.metric, contacts, moverOf, viewOf);
}

void BodyRigids::finish(BodyTable& table, std::vector<BodyState>& states) {
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
    const bool is_touched = m_world.isPushed(proxy.id) || state.is_joined || state.must_be_held;
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
