// The part of World that looks at how things meet without moving anything.

#include "engine/world/FreeRoom.h"
#include "engine/world/HitList.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

Contact World::firstContact(const Object* p_o, Vector where) const {
  const Contact nobody{nullptr, 1, where};
  const auto target = toFixed(where);
  if (!owns(p_o) || !target || !m_p_store->collides(p_o->m_slot)) return nobody;
  const SweepPath way(m_p_store->box(p_o->m_slot), m_p_store->position(p_o->m_slot), *target);
  thread_local HitList list;  // for its memory
  list.fill(*m_p_store, p_o->m_slot, way, HitList::kFirst);
  if (list.hits().empty()) return nobody;
  const Hit& first = list.hits().front();
  return {m_p_store->object(first.key.slot), first.moment.toDouble(),
          Vector::fromFixed(way.sweep().before(first.moment))};
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
