// The part of World that searches: Objects by what is true of them, collisions and room without a move.

#include <typeinfo>

#include "engine/world/ClassName.h"
#include "engine/world/CollisionRule.h"
#include "engine/world/FreeRoom.h"
#include "engine/world/HitList.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

/// Types that objectsOfType() looks into when it finds none.
constexpr std::size_t kMaxMissing = 100;

}  // namespace

template <class Wanted>
ObjectList World::collect(Wanted wanted) const {
  ObjectList list;
  const WorldStore::Walk walk(*m_p_store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const WorldStore::Slot s = walk[i];
    if (s != WorldStore::kNoSlot && wanted(s)) list.append(m_p_store, m_p_store->key(s));
  }
  return list;
}

ObjectList World::getAllObjects(bool inactive) const {
  return collect([&](auto s) { return inactive || m_p_store->has(s, WorldStore::kActive); });
}

ObjectList World::objectsOfType(const std::string& type) const {
  ObjectList found = collect([&](auto s) {
    return m_p_store->has(s, WorldStore::kActive) && m_p_store->object(s)->getType() == type;
  });
  if (found.isEmpty()) explainMissing(type);
  return found;
}

// Once for each type that was asked for in vain: the look at all Objects is not free.
void World::explainMissing(const std::string& type) const {
  if (m_missing.size() >= kMaxMissing || !m_missing.insert(type).second) return;
  const auto isNamed = [this, &type](auto s) {
    const Object& object = *m_p_store->object(s);
    const std::string name = classNameOf(typeid(object));
    return name == type || name.ends_with("::" + type);
  };
  if (collect(isNamed).isEmpty()) return;
  logOnce("WM.objectsOfType(\"" + type + "\") finds none: class " + type + " does not call setType(\"" +
          type + "\")");
}

ObjectList World::solidObjects() const {
  return collect([&](auto s) { return m_p_store->collides(s); });
}

Object* World::objectWithId(int id) const {
  const ObjectList found = collect([&](auto s) { return m_p_store->object(s)->getId() == id; });
  return found[0];
}

// The cells that a box of an Object at `position` is drawn in; what is smaller than a cell is drawn in one.
static bool coversCell(Fixed position, Fixed corner, Fixed extent, std::int32_t cell) {
  if (extent < kFixedOne) return cellOf(position + corner + extent / 2) == cell;
  return cellOf(position + corner + kFixedOne / 2) <= cell &&
         cell <= cellOf(position + corner + extent - kFixedOne / 2);
}

ObjectList World::objectsSeenAt(Vector cell) const {
  const auto where = toFixed(cell);
  if (!where) return {};
  return collect([&](auto s) {
    if (!m_p_store->has(s, WorldStore::kActive) || !m_p_store->has(s, WorldStore::kVisible)) return false;
    std::optional<FixedVector> p = m_p_store->position(s);
    if (m_p_lag_compensation != nullptr && m_input_seen.known) {
      p = m_p_lag_compensation->positionOf(m_p_store->key(s), m_input_seen);
    }
    const FixedBox box = m_p_store->box(s);
    return p && coversCell(p->x, box.corner.x, box.size.x, cellOf(where->x)) &&
           coversCell(p->y, box.corner.y, box.size.y, cellOf(where->y));
  });
}

ObjectList World::getCollisions(const Object* p_o, Vector where) const {
  ObjectList list;
  const auto target = toFixed(where);
  if (p_o == nullptr || p_o->m_p_store != m_p_store || !target) return list;
  std::vector<ObjectKey> keys;
  const FixedBox box = m_p_store->worldBox(p_o->m_slot, *target);
  m_p_store->touching(box, p_o->m_slot, keys);
  keepCollisions(*m_p_store, p_o->m_slot, box, keys);
  for (const ObjectKey key : keys) list.append(m_p_store, key);
  return list;
}

Contact World::firstContact(const Object* p_o, Vector where) const {
  const Contact none{nullptr, 1, where};
  const auto target = toFixed(where);
  if (!owns(p_o) || !target || !m_p_store->collides(p_o->m_slot)) return none;
  const SweepPath path(m_p_store->box(p_o->m_slot), m_p_store->position(p_o->m_slot), *target);
  thread_local HitList list;  // for its memory
  list.fill(*m_p_store, p_o->m_slot, path, HitList::kFirst);
  if (list.hits().empty()) return none;
  const Hit& first = list.hits().front();
  return {m_p_store->object(first.key.slot), first.moment.toDouble(),
          Vector::fromFixed(path.sweep().before(first.moment))};
}

std::optional<Vector> World::findFree(Box box, Vector near) {
  const auto place = toFixed(box);
  const auto position = toFixed(near);
  if (!place || !position) {
    refuse("WorldManager", "findFree");
    return std::nullopt;
  }
  FreeRoom room(*m_p_store, m_views->boundary(), translate(*place, *position));
  const std::optional<FixedVector> offset = room.nearest();
  if (!offset) return std::nullopt;
  return Vector::fromFixed(*position + *offset);
}

}  // namespace df
