#include "physics/substep/SubstepWorld.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/geometry/Reserve.h"
namespace naiad::physics {

namespace {

constexpr double kRollKept = 0.02;  // in thicknesses: while corners have moved by less, old bounds are used

bool isPulled(const RigidBody& body) {
  return body.acceleration != Vec2{} || body.torque != 0;
}

}  // namespace

void SubstepWorld::expect(std::size_t bodies) {
  reserveFor(m_bodies, bodies);
  reserveFor(m_states, bodies + 1);
  reserveFor(m_active, bodies);
}

int SubstepWorld::addInOrder(std::uint64_t order, const RigidBody& body,
                             std::span<const ConvexShape> shapes) {
  if (!isValid(body)) return -1;
  int id = idLimit();
  if (m_free.empty()) {
    m_bodies.emplace_back();
  } else {
    id = m_free.back();
    m_free.pop_back();
  }
  SubstepBody& b = m_bodies[at(id)];
  b = {};
  b.form = m_forms.take(shapes);
  b.body = body;
  b.body.place = body.place + Vec2{};
  b.order = order;
  b.exists = true;
  b.ring = id;
  measure(b);
  enter(id);
  return id;
}

void SubstepWorld::measure(SubstepBody& b) {
  const SubstepForm& form = m_forms[b.form];
  ++b.version;
  b.turned.resize(form.corners);
  b.reach = form.reach;
  b.thickness = form.thickness;
}

// Rotates the body's corners and bounds to its present rotation, unless they already have it.
void SubstepWorld::turnShapes(SubstepBody& b) {
  if (b.turned_at == b.body.rotation && b.turned_version == b.version) return;
  b.turned_at = b.body.rotation;
  b.turned_version = b.version;
  b.bounds = {{b.reach, b.reach}, {-b.reach, -b.reach}};
  std::span<Vec2> corners = b.turned;
  for (const ConvexShape& shape : m_forms[b.form].shapes) {
    turn(shape, b.body.rotation, corners);
    const Bounds own = boundsOf(rotatedView(shape, corners));
    b.bounds.lower = {std::min(b.bounds.lower.x, own.lower.x), std::min(b.bounds.lower.y, own.lower.y)};
    b.bounds.upper = {std::max(b.bounds.upper.x, own.upper.x), std::max(b.bounds.upper.y, own.upper.y)};
    corners = corners.subspan(2 * at(shape.count));
  }
}

// Returns a shape with the rotation of the last turnShapes().
RotatedView SubstepWorld::turnedShape(const SubstepBody& b, std::int32_t number) const {
  const ConvexShape* const p_shapes = m_forms[b.form].shapes.data();
  const Vec2* p_corners = b.turned.data();
  for (std::int32_t i = 0; i < number; ++i) p_corners += std::ptrdiff_t{2} * p_shapes[i].count;
  const ConvexShape& shape = p_shapes[number];
  return {shape.count, shape.radius, shape.reach, p_corners, p_corners + shape.count};
}

// Updates the body's box. If the body has hardly rotated since turnShapes(), only widens the old bounds.
void SubstepWorld::boundNow(SubstepBody& b) {
  const Rotation at = b.turned_at, now = b.body.rotation;
  const double roll = std::fabs(at.c * now.s - at.s * now.c) * b.reach;
  const bool is_near =
      b.turned_version == b.version && roll <= kRollKept * b.thickness && at.c * now.c + at.s * now.s > 0;
  if (!is_near) turnShapes(b);
  const double wider = is_near ? 2 * roll : 0;
  b.box = {b.bounds.lower - Vec2{wider, wider}, b.bounds.upper + Vec2{wider, wider}};
}

// Resets the body's state and adds it to the broad phase.
void SubstepWorld::enter(int id) {
  SubstepBody& b = m_bodies[at(id)];
  b.is_frozen = b.is_asleep = false;
  b.ring = id;
  // A body without acceleration and torque starts as nearly still: if it is at rest, it sleeps after a tick.
  b.still = isPulled(b.body) ? 0 : m_options.sleep_delay - 1;
  b.margin = b.roll = b.first_speed = 0;
  b.drift = {};
  m_active_changed = true;
  if (!isMovable(b)) markChanged(id);
  if (m_forms[b.form].shapes.empty()) return;
  boundNow(b);
  const bool moves = isMovable(b);
  if (moves) forecast(b);
  const GridBounds wide = moves ? wideBounds(b) : gridBounds(b.body.place, b.box, 0);
  b.proxy = m_broad.add(static_cast<std::uint32_t>(id), wide, moves, b.order);
}

// Removes the body from the broad phase; the next step drops its contacts.
void SubstepWorld::leave(int id) {
  SubstepBody& b = m_bodies[at(id)];
  if (b.proxy >= 0) m_broad.remove(b.proxy);
  b.proxy = -1;
  b.state = 0;
  markChanged(id);
  m_active_changed = true;
}

// Makes the next step wake the bodies that touch this one or are joined to it.
void SubstepWorld::markChanged(int id) {
  SubstepBody& b = m_bodies[at(id)];
  if (!b.is_changed) m_changed.push_back(id);
  b.is_changed = true;
}

void SubstepWorld::freeze(int id) {
  wakeRing(id);
  leave(id);
  m_bodies[at(id)].is_frozen = true;
  ++m_counters.quarantined;
}

bool SubstepWorld::set(int id, const RigidBody& body) {
  if (!exists(id)) return false;
  SubstepBody& b = m_bodies[at(id)];
  if (b.body == body && !b.is_frozen) return true;
  if (!isValid(body)) return false;
  const bool was_movable = isMovable(b);
  if (b.body.turn_rate == 0 || body.turn_rate == 0) forget(id);  // a magnet changes it in each tick
  wakeRing(id);
  b.still = 0;
  b.body = body;
  b.body.place = body.place + Vec2{};
  m_active_changed = true;
  if (b.is_frozen || was_movable != isMovable(b)) {
    leave(id);
    enter(id);
  } else if (!was_movable) {
    markChanged(id);
    b.drift = {};
    b.roll = 0;
    b.is_busy = true;
    if (b.proxy >= 0) {
      boundNow(b);
      m_broad.set(b.proxy, gridBounds(b.body.place, b.box, 0));
    }
  }
  return true;
}

bool SubstepWorld::setShapes(int id, std::span<const ConvexShape> shapes) {
  if (!exists(id)) return false;
  wakeRing(id);
  leave(id);
  SubstepBody& b = m_bodies[at(id)];
  m_forms.giveBack(std::exchange(b.form, m_forms.take(shapes)));
  measure(b);
  enter(id);
  forget(id);
  return true;
}

// Removes a body. Its id can be used again after the next step has dropped its pairs.
bool SubstepWorld::remove(int id) {
  if (!exists(id)) return false;
  wakeRing(id);
  removeJointsOf(id);
  leave(id);
  m_forms.giveBack(std::exchange(m_bodies[at(id)].form, -1));
  m_bodies[at(id)].exists = false;
  return true;
}

void SubstepWorld::wakeRing(int id) {
  m_bodies[at(id)].still = 0;
  if (!m_bodies[at(id)].is_asleep) return;
  m_active_changed = true;
  int member = id;
  do {
    SubstepBody& b = m_bodies[at(member)];
    b.is_asleep = false;
    b.still = 0;
    const int next = b.ring;
    b.ring = member;
    member = next;
  } while (member != id);
}

void SubstepWorld::setSleeping(bool may_sleep) {
  m_options.may_sleep = may_sleep;
  if (may_sleep) return;
  for (int id = 0; id < idLimit(); ++id) wakeRing(id);
}

}  // namespace naiad::physics
