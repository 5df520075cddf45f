#include "physics/body/BodyImpacts.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

namespace {

constexpr int kMaxRounds = 100;  // rounds of a tick that search for obstacles; further rounds only step
constexpr double kRoom = 0.25;   // metric cells: margin around the area that a body reaches by itself

Vec2 sizeOf(Vec2 a) {
  return {std::fabs(a.x), std::fabs(a.y)};
}

// True if the polygon is a box along the axes around the origin. Then sets its half size.
bool isUpright(const ConvexShape& shape, Vec2& half) {
  if (shape.count != 4 || shape.radius != 0) return false;
  half = sizeOf(shape.vertices[0]);
  for (int i = 0; i < 4; ++i) {
    if (sizeOf(shape.vertices[i]) != half) return false;
  }
  return half.x > 0 && half.y > 0;
}

}  // namespace

bool BodyImpacts::canHave(const BodyGeometry& form, const Metric& metric, const FixedBox& box,
                          ImpactBody& body, Vec2& offset) {
  offset = {};
  const bool is_round =
      form.shapes.size() == 1 && form.shapes[0].count == 1 && form.shapes[0].vertices[0] == Vec2{};
  if (form.is_turning || form.shapes.size() > 1) return false;
  if (is_round) {
    body.shape = ImpactShape::kCircle;
    body.half = {form.shapes[0].radius, 0};
    return true;
  }
  if (form.rotation != Rotation{} || form.spin != 0) return false;
  body.shape = ImpactShape::kBox;
  if (!form.shapes.empty()) return isUpright(form.shapes[0], body.half);
  body.half = 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  offset = metric.fromCells(Vector::fromFixed(box.corner)) + body.half;
  return true;
}

void BodyImpacts::beginTick() {
  m_active.clear();
  m_state_of.clear();
  for (Proxy& proxy : m_proxies) proxy.is_used = false;
}

// Replaces a bent path by one with a constant acceleration, because an ImpactWorld has no other paths. It has
// the start, end and final velocity of the flight; for a touching body, the first and final velocity.
void BodyImpacts::adapt(const BodyState& state, const BodyRow& row, ImpactBody& body) {
  body.velocity = state.start_velocity;
  body.acceleration = state.push;
  const Proxy& proxy = m_proxies[state.index];
  if (row.inverse_mass == 0) return;
  if (!state.is_bent) return;
  body.acceleration = state.flown.velocity - state.start_velocity;
  if (proxy.id >= 0 && m_world.isTouching(proxy.id)) return;
  body.velocity = 2 * state.flown.displacement - state.flown.velocity;
  body.acceleration = 2 * (state.flown.velocity - state.flown.displacement);
}

bool BodyImpacts::add(const BodyState& state, const BodyRow& row, ImpactBody body, Vec2 offset,
                      BodyContacts& contacts) {
  if (state.index >= m_proxies.size()) m_proxies.resize(state.index + 1);
  Proxy& proxy = m_proxies[state.index];
  if (proxy.id >= 0 && proxy.order != row.order) {  // the entry belongs to a deleted body of this row
    contacts.expire(m_identities[static_cast<std::size_t>(proxy.id)].key, BodySolver::kImpact);
    m_world.remove(proxy.id);
    proxy = {};
  }
  proxy.order = row.order;
  proxy.is_used = true;
  adapt(state, row, body);
  // If the place is unchanged, the ImpactWorld's own value is used, to avoid another rounding.
  const bool is_unchanged = proxy.id >= 0 && proxy.row_place == row.place && proxy.offset == offset;
  body.place = is_unchanged ? proxy.world_place : row.place + offset;
  proxy.offset = offset;
  body.inverse_mass = row.inverse_mass;
  body.restitution = row.restitution;
  body.friction = row.friction;
  if (!isValid(body)) return proxy.is_used = false;
  m_active.push_back({state.index, body, {}, {}});
  return true;
}

// Adds new bodies and removes those that left. Ids are given in the order of construction.
void BodyImpacts::updateBodies(BodyContacts& contacts) {
  for (Proxy& proxy : m_proxies) {
    if (proxy.is_used || proxy.id < 0) continue;
    contacts.expire(m_identities[static_cast<std::size_t>(proxy.id)].key, BodySolver::kImpact);
    m_world.remove(proxy.id);
    proxy.id = -1;
  }
  for (const ActiveBody& active : m_active) {
    Proxy& proxy = m_proxies[active.index];
    if (proxy.id < 0) {
      proxy.id = m_world.add(active.body);
    } else {
      const bool was_pushed = m_world.body(proxy.id).inverse_mass > 0;
      if (was_pushed != (active.body.inverse_mass > 0))  // then the ImpactWorld drops its contacts
        contacts.handOver(m_identities[static_cast<std::size_t>(proxy.id)].key);
      m_world.set(proxy.id, active.body);
    }
  }
}

void BodyImpacts::identify(int id, const Identity& identity) {
  if (id >= static_cast<int>(m_identities.size())) m_identities.resize(static_cast<std::size_t>(id) + 1);
  m_identities[static_cast<std::size_t>(id)] = identity;
}

// Adds the region that the body may reach in the remaining time, at `room` times its present speed.
void BodyImpacts::searchAround(const BodyTable& table, ActiveBody& active, double left, double room) {
  const Proxy& proxy = m_proxies[active.index];
  const ImpactBody& body = m_world.body(proxy.id);
  const Vec2 half = halfExtentOf(body) + Vec2{kRoom, kRoom} + room * left * sizeOf(body.velocity) +
                    (0.5 * left * left) * sizeOf(body.acceleration);
  const Vec2 away = sizeOf(body.place - active.search_centre) + half;
  if (away.x > active.search_half.x || away.y > active.search_half.y) {
    active.search_centre = body.place;
    active.search_half = half;
    m_surroundings.addRegion(regionOf(table.metric, active.search_centre, half));
  }
  m_world.setReach(proxy.id, active.search_centre, active.search_half);
}

void BodyImpacts::updateObstacles(World& world, const BodyTable& table, BodyContacts& contacts) {
  const WorldStore& store = world.store();
  m_obstacles.update(store);
  for (const ObjectKey key : m_obstacles.farObjects()) contacts.expire(key, BodySolver::kImpact);
  for (const int id : m_obstacles.removedIds()) m_world.remove(id);
  std::vector<BodyObstacles::Block>& blocks = m_obstacles.blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    BodyObstacles::Block& block = blocks[i];
    const FixedBox box = block.shape.area.box();
    ImpactBody body;
    body.half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    body.place = table.metric.placeOf(box.corner) + body.half;
    body.inverse_mass = 0;
    body.friction = table.settings.obstacle_friction;
    body.restitution = table.settings.obstacle_restitution;
    const bool is_known = block.id >= 0 && block.size == box.size;
    if (!is_known || !m_world.set(block.id, body)) {
      if (block.id >= 0) m_world.remove(block.id);
      block.id = m_world.add(body);
      block.size = box.size;
    }
    const int number = block.is_whole_object ? -1 : static_cast<int>(i);
    if (block.id >= 0) identify(block.id, {block.key, store.order(block.key.slot), -1, number});
  }
}

void BodyImpacts::step(World& world, const BodyTable& table, std::vector<BodyState>& states,
                       BodyContacts& contacts) {
  m_was_active = !m_active.empty();
  updateBodies(contacts);
  m_state_of.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].solver == BodySolver::kImpact) {
      identify(m_proxies[states[i].index].id, {states[i].key, states[i].order, static_cast<int>(i)});
      states[i].is_touched = m_world.isTouching(m_proxies[states[i].index].id);
      m_state_of.push_back(static_cast<int>(i));
    }
  }
  m_obstacles.beginTick();
  m_found_contacts.clear();
  double done = 0;
  for (int round = 0;; ++round) {
    const double left = 1 - done;
    m_surroundings.clear();
    for (ActiveBody& active : m_active) {
      const bool searches = active.body.inverse_mass > 0 && round < kMaxRounds;
      if (searches) searchAround(table, active, left, round == 0 ? 1 : 2);
    }
    m_surroundings.query(world.store(), [&](std::size_t /*number*/, ObjectKey key) {
      if (BodyObstacles::isObstacle(world.store(), key)) m_obstacles.markNear(key);
    });
    updateObstacles(world, table, contacts);
    m_world.step(left, round > 0);
    collect(done);
    done += m_world.stepped();
    if (m_world.stepped() == left || done >= 1) break;
  }
  for (const int at : m_state_of) {
    BodyState& state = states[static_cast<std::size_t>(at)];
    state.is_costly = m_world.isGivenUp(m_proxies[state.index].id);
  }
}

void BodyImpacts::passOn(const BodyState& state) {
  Proxy& proxy = m_proxies[state.index];
  m_world.remove(proxy.id);
  proxy.id = -1;
  proxy.is_used = false;
}

void BodyImpacts::collect(double since) {
  for (const ImpactEvent& event : m_world.events()) {
    const Identity* p_first = &m_identities[static_cast<std::size_t>(event.first)];
    const Identity* p_second = &m_identities[static_cast<std::size_t>(event.second)];
    const bool is_swapped = p_first->state < 0 || (p_second->state >= 0 && p_second->order < p_first->order);
    if (is_swapped) std::swap(p_first, p_second);
    m_found_contacts.push_back({{since + event.time, p_first->key, p_second->key, p_first->order,
                                 p_second->order, event.impulse, event.is_begin, BodySolver::kImpact},
                                {p_first->state, p_second->state},
                                is_swapped ? event.second : event.first,
                                p_second->block < 0 ? -1
                                : is_swapped        ? event.first
                                                    : event.second});
  }
}

// Sets the results in the states, except those of bodies for which passOn() was called.
void BodyImpacts::finish(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states,
                         BodyContacts& contacts) {
  const auto isPassedOn = [&](int state) {
    return state >= 0 && states[static_cast<std::size_t>(state)].solver != BodySolver::kImpact;
  };
  for (const FoundContact& found : m_found_contacts) {
    if (isPassedOn(found.states[0]) || isPassedOn(found.states[1])) continue;
    for (const int at : found.states) {
      if (at < 0) continue;
      BodyState& state = states[static_cast<std::size_t>(at)];
      state.is_touched = state.contacts_changed = true;
    }
    if (found.block < 0) {
      contacts.add(found.contact);
    } else {
      m_block_contacts.add(found.contact, found.body, found.block);
    }
  }
  if (!m_block_contacts.isEmpty()) settleBlocks(store, table.metric, states, contacts);
  for (const int at : m_state_of) {
    BodyState& state = states[static_cast<std::size_t>(at)];
    if (state.solver != BodySolver::kImpact) continue;
    Proxy& proxy = m_proxies[state.index];
    const ImpactBody& body = m_world.body(proxy.id);
    if (m_world.isFrozen(proxy.id)) state.p_failure = "its motion cannot be computed";
    state.is_touched = state.is_touched || m_world.isTouching(proxy.id);
    if (!state.is_touched) {  // then the flight alone gives the exact result
      state.place = state.start + state.flown.displacement;
      state.velocity = state.flown.velocity;
    } else {
      state.place = proxy.offset == Vec2{} ? body.place : body.place + -proxy.offset;
      state.velocity = body.velocity;
      state.acceleration = m_world.acceleration(proxy.id);
    }
    proxy.row_place = state.place;
    proxy.world_place = state.is_touched ? body.place : state.place + proxy.offset;
  }
}

void BodyImpacts::settleBlocks(const WorldStore& store, const Metric& metric,
                               const std::vector<BodyState>& states, BodyContacts& contacts) {
  ConvexShape made;
  const auto moverOf = [&](int id) {
    BlockContacts::Mover mover;
    const int index = m_world.exists(id) ? m_identities[static_cast<std::size_t>(id)].state : -1;
    if (index < 0 || states[static_cast<std::size_t>(index)].solver != BodySolver::kImpact) return mover;
    const BodyState& state = states[static_cast<std::size_t>(index)];
    const ImpactBody& body = m_world.body(id);
    const ShapeStatus status = body.shape == ImpactShape::kCircle
                                   ? makeCircle(body.half.x, {}, made)
                                   : makeBox(body.half.x, body.half.y, {}, {}, 0, made);
    mover.key = state.key;
    if (status == ShapeStatus::kOk) mover.shapes = {&made, 1};
    mover.start.place = state.start + m_proxies[state.index].offset;
    mover.end.place = body.place;
    mover.velocity = state.start_velocity;
    return mover;
  };
  const auto viewOf = [&](int id) {
    const int index = m_world.exists(id) ? m_identities[static_cast<std::size_t>(id)].block : -1;
    BlockContacts::View view;
    if (index >= 0) view.p_shape = &m_obstacles.blocks()[static_cast<std::size_t>(index)].shape;
    return view;
  };
  m_block_contacts.settle(store, metric, contacts, moverOf, viewOf);
}

}  // namespace naiad::physics
