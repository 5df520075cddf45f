#include "Oracle.h"

#include <algorithm>
#include <cmath>

namespace oracle {

bool boxIntersectsBox(const FixedBox& a, const FixedBox& b) {
  const bool x_overlap = b.corner.x <= a.corner.x + a.size.x && a.corner.x <= b.corner.x + b.size.x;
  const bool y_overlap = b.corner.y <= a.corner.y + a.size.y && a.corner.y <= b.corner.y + b.size.y;
  return x_overlap && y_overlap;
}

/// The Object's box if it were at `where` (section 4.13, getWorldBox).
static FixedBox getWorldBox(const Object* p_o, FixedVector where) {
  return {p_o->box.corner + where, p_o->box.size};
}

void Object::setVelocity(double x, double y) {
  const double speed = std::sqrt(x * x + y * y);
  const double direction_x = speed > 0 ? x / speed : 0;
  const double direction_y = speed > 0 ? y / speed : 0;
  velocity = {*df::toFixed(direction_x * speed), *df::toFixed(direction_y * speed)};
}

Object* World::create(int id) {
  m_memory.push_back(std::make_unique<Object>());
  Object* p_o = m_memory.back().get();
  p_o->id = id;
  m_updates.push_back(p_o);
  return p_o;
}

void World::markForDelete(Object* p_o) {
  if (std::find(m_deletions.begin(), m_deletions.end(), p_o) == m_deletions.end()) m_deletions.push_back(p_o);
}

void World::destroy(Object* p_o) {
  m_handlers.destroyed(p_o);
  remove(p_o);
}

void World::remove(Object* p_o) {
  p_o->gone = true;
  std::erase(m_updates, p_o);
}

Object* World::insert(const Object* p_o) {
  Object* p_again = create(p_o->id);
  *p_again = *p_o;
  p_again->gone = false;
  return p_again;
}

void World::step() {
  const ObjectList list = m_updates;
  for (Object* p_o : list) {
    if (!p_o->gone && p_o->active) m_handlers.step(p_o);
  }
}

// Listing 4.101.
void World::update() {
  const ObjectList list = m_updates;  // an Object that is born during the update waits for the next one
  for (Object* p_o : list) {
    if (p_o->gone || !p_o->active) continue;

    // Add velocity to position. If the Object should change position, then move.
    const FixedVector new_pos = p_o->predictPosition();
    if (new_pos != p_o->position) moveObject(p_o, new_pos);

    if (!p_o->gone) p_o->velocity = p_o->velocity + p_o->acceleration;
  }

  for (Object* p_o : m_deletions) {
    if (!p_o->gone) destroy(p_o);
  }
  m_deletions.clear();
}

// Listing 4.108.
ObjectList World::getCollisions(const Object* p_o, FixedVector where) const {
  ObjectList collision_list;
  const FixedBox box = getWorldBox(p_o, where);
  for (Object* p_temp_o : m_updates) {
    if (p_temp_o == p_o) continue;  // not with itself
    if (p_temp_o->active && p_temp_o->isSolid() &&
        boxIntersectsBox(getWorldBox(p_temp_o, p_temp_o->position), box)) {
      collision_list.push_back(p_temp_o);
    }
  }
  return collision_list;
}

// A handler that moves on every collision would never come back, so there is a deepest move.
int World::moveObject(Object* p_o, FixedVector where) {
  ++m_counters.moves;
  if (m_depth > 0) ++m_counters.nested_moves;
  if (m_depth == kDeepestMove) {
    ++m_counters.too_deep;
    return -1;
  }
  ++m_depth;
  const int result = moveNow(p_o, where);
  --m_depth;
  return result;
}

// Listings 4.109, 4.111 and 4.113.
int World::moveNow(Object* p_o, FixedVector where) {
  if (!p_o->active) {  // takes no part in collisions and hears nothing, so it is only placed
    p_o->position = where;
    return 0;
  }
  if (p_o->isSolid()) {
    const ObjectList list = getCollisions(p_o, where);
    bool hard_block = false;
    bool soft_block = false;
    bool met_soft = false;

    for (Object* p_temp_o : list) {
      if (p_temp_o->gone) continue;
      ++m_counters.collisions;
      if (!met_soft && (p_o->solidness == df::SOFT || p_temp_o->solidness == df::SOFT)) {
        met_soft = true;
        ++m_counters.met_soft;
      }

      // Send to both objects; either handler may delete either of them.
      if (p_o->active) m_handlers.collision(p_o, p_o, p_temp_o, where);
      if (p_o->gone) return -1;
      if (p_temp_o->gone) continue;
      if (p_temp_o->active) m_handlers.collision(p_temp_o, p_o, p_temp_o, where);
      if (p_o->gone) return -1;
      if (p_temp_o->gone) continue;

      // If both HARD, then cannot move.
      if (p_o->solidness == df::HARD && p_temp_o->solidness == df::HARD) hard_block = true;
      // If object does not want to move onto soft objects, don't move.
      if (p_o->no_soft && p_temp_o->solidness == df::SOFT) soft_block = true;
    }

    if (hard_block || soft_block) {
      if (hard_block) ++m_counters.blocked_hard;
      if (soft_block) ++m_counters.blocked_soft;
      return -1;  // move not allowed
    }
  }

  // If here, no collision that impedes, so allow the move.
  const bool was_inside = isInside(p_o->position);
  p_o->position = where;

  // Once, when the Object leaves the world.
  if (was_inside && !isInside(where)) {
    ++m_counters.outs;
    if (p_o->active) m_handlers.out(p_o);
  }
  return 0;
}

bool World::isInside(FixedVector position) const {
  const FixedVector p = position - m_boundary.corner;
  return p.x >= 0 && p.x < m_boundary.size.x && p.y >= 0 && p.y < m_boundary.size.y;
}

}  // namespace oracle
