#include "physics/rigid/RigidWorld.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Reserve.h"

namespace naiad::physics {

void RigidWorld::expect(std::size_t bodies) {
  reserveFor(m_bodies, bodies);
  reserveFor(m_extras, bodies);
  reserveFor(m_states, bodies);
}

int RigidWorld::addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) {
  if (!isValid(body)) return -1;
  int id = m_first_free;
  while (id < idLimit() && m_extras[at(id)].exists) ++id;
  m_first_free = id + 1;
  if (id == idLimit()) {
    m_bodies.emplace_back();
    m_extras.emplace_back();
    m_states.emplace_back();
    m_island_of.emplace_back();
    m_island_still.emplace_back();
    m_island_gain.emplace_back();
    m_island_flags.emplace_back();
  }
  Extra& extra = m_extras[at(id)];
  extra = {};
  extra.exists = true;
  extra.order = order;
  extra.ring = id;
  extra.shapes.assign(shapes.begin(), shapes.end());
  m_bodies[at(id)] = body;
  m_bodies[at(id)].place = body.place + Vec2{};
  measure(id);
  enter(id);
  return id;
}

bool RigidWorld::set(int id, const RigidBody& body) {
  if (!exists(id) || !isValid(body)) return false;
  Extra& extra = m_extras[at(id)];
  RigidBody& own = m_bodies[at(id)];
  if (own == body && !extra.is_frozen) return true;
  const bool was_movable = isMovable(id);
  if (own.turn_rate == 0 || body.turn_rate == 0) forget(id);  // a magnet changes it in each tick
  if ((own.turn_rate != 0) != (body.turn_rate != 0)) m_linkages_changed = true;
  wakeRing(id);
  if (!was_movable) wakeNeighbours(id);
  own = body;
  own.place = body.place + Vec2{};
  extra.still = 0;
  if (extra.is_frozen || was_movable != isMovable(id)) {
    leave(id);
    keepTouching(id);
    forgetPairs(id);  // its pairs must be found again, because their order has changed
    enter(id);
  } else if (!was_movable) {
    if (!extra.is_dirty) m_dirty.push_back(id);
    extra.is_dirty = true;
    m_active_changed = true;
  }
  return true;
}

bool RigidWorld::setShapes(int id, std::span<const ConvexShape> shapes) {
  if (!exists(id)) return false;
  wakeRing(id);
  wakeNeighbours(id);
  leave(id);
  m_extras[at(id)].shapes.assign(shapes.begin(), shapes.end());
  measure(id);
  enter(id);
  forget(id);
  return true;
}

bool RigidWorld::remove(int id) {
  if (!exists(id)) return false;
  wakeRing(id);
  wakeNeighbours(id);
  removeJointsOf(id);
  leave(id);
  forgetPairs(id);
  std::erase_if(m_late, [id](const Late& late) { return late.a == id || late.b == id; });
  m_extras[at(id)].exists = false;
  m_first_free = std::min(m_first_free, id);
  return true;
}

void RigidWorld::measure(int id) {
  Extra& extra = m_extras[at(id)];
  extra.turned.resize(extra.shapes.size());
  extra.reach = 0;
  extra.thickness = extra.shapes.empty() ? 0 : kMaxShapeExtent;
  for (const ConvexShape& shape : extra.shapes) {
    extra.reach = std::max(extra.reach, shape.reach + shape.radius);
    extra.thickness = std::min(extra.thickness, thicknessOf(shape));
  }
}

Bounds RigidWorld::turnShapes(int id, Rotation rotation) {
  Extra& extra = m_extras[at(id)];
  Bounds bounds = {{extra.reach, extra.reach}, {-extra.reach, -extra.reach}};
  for (std::size_t i = 0; i < extra.shapes.size(); ++i) {
    turn(extra.shapes[i], rotation, extra.turned[i]);
    const Bounds own = boundsOf(extra.turned[i]);
    bounds.lower = {std::min(bounds.lower.x, own.lower.x), std::min(bounds.lower.y, own.lower.y)};
    bounds.upper = {std::max(bounds.upper.x, own.upper.x), std::max(bounds.upper.y, own.upper.y)};
  }
  return bounds;
}

// Resets the body's state and adds it to the broad phase.
void RigidWorld::enter(int id) {
  Extra& extra = m_extras[at(id)];
  extra.is_frozen = extra.is_asleep = false;
  extra.margin = extra.moved = extra.rolled = 0;
  m_states[at(id)] = {};
  m_active_changed = m_linkages_changed = true;
  if (!isMovable(id)) {
    if (!extra.is_dirty) m_dirty.push_back(id);
    extra.is_dirty = true;
  }
  if (extra.shapes.empty()) return;
  const RigidBody& body = m_bodies[at(id)];
  const Bounds bounds = turnShapes(id, body.rotation);
  extra.proxy = m_broad.add(static_cast<std::uint32_t>(id), gridBounds(body.place, bounds, 0), isMovable(id),
                            extra.order);
}

// Removes the body from the broad phase and drops its contacts.
void RigidWorld::leave(int id) {
  Extra& extra = m_extras[at(id)];
  if (extra.proxy >= 0) m_broad.remove(extra.proxy);
  extra.proxy = -1;
  for (Pair& pair : m_pairs) {
    if (pair.a != id && pair.b != id) continue;
    dropContacts(pair);
  }
  m_active_changed = m_linkages_changed = true;
}

void RigidWorld::freeze(int id) {
  wakeNeighbours(id);
  leave(id);
  m_extras[at(id)].is_frozen = true;
  m_states[at(id)] = {};
  ++m_counters.quarantined;
}

}  // namespace naiad::physics
