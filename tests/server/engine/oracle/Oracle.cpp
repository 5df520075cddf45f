#include "Oracle.h"

#include <algorithm>

namespace oracle {

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
  const ObjectList list = m_updates;  // an Object created during the update waits for the next one
  for (Object* p_o : list) {
    if (p_o->gone || !p_o->active) continue;

    // Add velocity to position. If the Object should change position, then move.
    const FixedVector new_pos = p_o->predictPosition();
    const std::int64_t collisions_before = m_counters.collisions;
    const bool rests = new_pos == p_o->position;
    if (!rests || p_o->options.rest_contacts) moveObject(p_o, new_pos);
    if (rests && p_o->options.rest_contacts) {
      ++m_counters.rest_moves;
      if (m_counters.collisions > collisions_before) ++m_counters.rest_contacts;
    }

    if (!p_o->gone) p_o->velocity = p_o->velocity + p_o->acceleration;
  }

  for (Object* p_o : m_deletions) {
    if (!p_o->gone) destroy(p_o);
  }
  m_deletions.clear();
}

// A handler that moves its Object at every collision would never return, so nested moves have a limit.
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

/// Sets the Object's position to the end of its move (Listing 4.113).
void World::place(Object* p_o, FixedVector where) {
  const bool was_inside = isInside(p_o->position);
  p_o->position = where;

  // Sends one event when the Object leaves the world.
  if (was_inside && !isInside(where)) {
    ++m_counters.outs;
    if (p_o->active) m_handlers.out(p_o);
  }
}

bool World::isInside(FixedVector position) const {
  const FixedVector p = position - m_boundary.corner;
  return p.x >= 0 && p.x < m_boundary.size.x && p.y >= 0 && p.y < m_boundary.size.y;
}

// findFree().

/// True if `box`, in world coordinates, touches no solid Object.
bool World::isFree(const FixedBox& box) const {
  return std::none_of(m_updates.begin(), m_updates.end(), [&](const Object* p_o) {
    return p_o->active && p_o->isSolid() && boxIntersectsBox(p_o->getWorldBox(p_o->position), box);
  });
}

/// Returns the whole-cell offsets that keep an interval of this `size` at `low` between `least` and `most`,
/// edges included. Smaller distances come first, and the negative offset before the positive one.
static std::vector<int> offsets(Fixed low, Fixed size, Fixed least, Fixed most) {
  std::vector<int> result;
  for (int distance = 0; distance <= World::kFarthestFree; ++distance) {
    for (const int cells : {-distance, distance}) {
      const Fixed moved = low + df::fromCells(cells);
      if (cells == 0 && !result.empty()) continue;
      if (moved >= least && moved + size <= most) result.push_back(cells);
    }
  }
  return result;
}

std::optional<FixedVector> World::findFree(const FixedBox& box, FixedVector near) const {
  const FixedVector low = box.corner + near;
  const FixedVector end = m_boundary.corner + m_boundary.size;
  const std::vector<int> columns = offsets(low.x, box.size.x, m_boundary.corner.x, end.x);
  const std::vector<int> rows = offsets(low.y, box.size.y, m_boundary.corner.y, end.y);

  struct Place {
    int distance;  ///< squared distance
    int y;
    int x;
    auto operator<=>(const Place&) const = default;
  };
  std::optional<Place> best;
  for (const int y : rows) {
    if (best && y * y > best->distance) break;
    for (const int x : columns) {
      const Place candidate{x * x + y * y, y, x};
      if (best && candidate.distance > best->distance) break;
      if (best && *best < candidate) continue;
      const FixedVector offset{df::fromCells(x), df::fromCells(y)};
      if (isFree(translate(box, near + offset))) best = candidate;
    }
  }
  if (!best) return std::nullopt;
  return near + FixedVector{df::fromCells(best->x), df::fromCells(best->y)};
}

}  // namespace oracle
