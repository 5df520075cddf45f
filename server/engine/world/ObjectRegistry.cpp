#include "engine/world/ObjectRegistry.h"

#include <typeinfo>

#include "engine/world/ClassName.h"
#include "engine/world/CollisionRule.h"
#include "engine/world/HitList.h"
#include "engine/world/Interests.h"
#include "engine/world/Object.h"
#include "engine/world/WorldLog.h"

namespace df {

bool ObjectRegistry::owns(const Object* p_o) const {
  // The slot may belong to another Object now, if the game holds a pointer to a deleted one.
  return p_o != nullptr && p_o->m_p_store == &m_store && m_store.has(p_o->m_slot, WorldStore::kInWorld) &&
         m_store.object(p_o->m_slot) == p_o;
}

int ObjectRegistry::insertObject(Object* p_o) {
  if (p_o == nullptr || p_o->m_p_store != &m_store || m_store.object(p_o->m_slot) != p_o) return -1;
  if (!owns(p_o)) m_store.enter(p_o->m_slot);
  return 0;
}

int ObjectRegistry::removeObject(Object* p_o) {
  if (!owns(p_o)) return -1;
  m_interests.removeAll(m_store.profile(p_o->m_slot));
  m_store.leave(p_o->m_slot);
  return 0;
}

int ObjectRegistry::markForDelete(Object* p_o) {
  if (!owns(p_o)) {
    m_log.writeOnce(p_o == nullptr ? "WM.markForDelete() of a null pointer"
                                   : "WM.markForDelete() of an Object that is not in the world (any more)");
    return -1;
  }
  if (m_store.has(p_o->m_slot, WorldStore::kMarked)) return 0;
  m_store.set(p_o->m_slot, WorldStore::kMarked, true);
  m_deletions.push_back(p_o->key());
  return 0;
}

void ObjectRegistry::deleteMarked() {
  // Destructors may mark more Objects, which this loop deletes, too.
  for (std::size_t i = 0; i < m_deletions.size(); ++i) {
    Object* p_o = m_store.find(m_deletions[i]);
    if (p_o == nullptr) continue;
    if (m_store.has(p_o->m_slot, WorldStore::kHeap)) {
      delete p_o;
      continue;
    }
    const std::string name = nameOf(*p_o);
    if (m_unowned.insert(name).second)
      m_log.write("Marked for deletion, but not made with new, so only removed: object of type " + name);
    removeObject(p_o);
  }
  m_deletions.clear();
}

// Destructors may make new Objects, which are deleted in the next round. The rounds are limited, because a
// game might always make more.
void ObjectRegistry::clear() {
  constexpr int kRounds = 100;
  for (int round = 0; round < kRounds && m_store.countInWorld() > 0; ++round) {
    const WorldStore::Walk walk(m_store);
    for (std::size_t i = 0; i < walk.size(); ++i) {
      const WorldStore::Slot s = walk[i];
      if (s == WorldStore::kNoSlot) continue;
      Object* p_o = m_store.object(s);
      if (m_store.has(s, WorldStore::kHeap)) {
        delete p_o;
      } else {
        removeObject(p_o);
      }
    }
  }
  m_store.closeGaps();
  m_deletions.clear();
  m_missing.clear();
  m_unowned.clear();
}

ObjectList ObjectRegistry::getAllObjects(bool inactive) const {
  return collect([&](auto s) { return inactive || m_store.has(s, WorldStore::kActive); });
}

ObjectList ObjectRegistry::objectsOfType(const std::string& type) {
  ObjectList found = collect(
      [&](auto s) { return m_store.has(s, WorldStore::kActive) && m_store.object(s)->getType() == type; });
  if (found.isEmpty()) logMissingType(type);
  return found;
}

// Logs each type that was not found only once, because this searches all Objects.
void ObjectRegistry::logMissingType(const std::string& type) {
  constexpr std::size_t kMaxMissing = 100;
  if (m_missing.size() >= kMaxMissing || !m_missing.insert(type).second) return;
  const auto isNamed = [this, &type](auto s) {
    const Object& object = *m_store.object(s);
    const std::string name = classNameOf(typeid(object));
    return name == type || name.ends_with("::" + type);
  };
  if (collect(isNamed).isEmpty()) return;
  m_log.writeOnce("WM.objectsOfType(\"" + type + "\") finds none: class " + type +
                  " does not call setType(\"" + type + "\")");
}

ObjectList ObjectRegistry::solidObjects() const {
  return collect([&](auto s) { return m_store.collides(s); });
}

Object* ObjectRegistry::objectWithId(int id) const {
  return collect([&](auto s) { return m_store.object(s)->getId() == id; })[0];
}

ObjectList ObjectRegistry::getCollisions(const Object* p_o, Vector where) const {
  ObjectList list;
  const auto target = toFixed(where);
  if (p_o == nullptr || p_o->m_p_store != &m_store || !target) return list;
  std::vector<ObjectKey> keys;
  const FixedBox box = m_store.worldBox(p_o->m_slot, *target);
  m_store.touching(box, p_o->m_slot, keys);
  filterCollisions(m_store, p_o->m_slot, box, keys);
  for (const ObjectKey key : keys) list.append(&m_store, key);
  return list;
}

Contact ObjectRegistry::firstContact(const Object* p_o, Vector where) const {
  const Contact none{nullptr, 1, where};
  const auto target = toFixed(where);
  if (!owns(p_o) || !target || !m_store.collides(p_o->m_slot)) return none;
  const SweepPath path(m_store.box(p_o->m_slot), m_store.position(p_o->m_slot), *target);
  thread_local HitList list;  // reuses its memory
  list.fill(m_store, p_o->m_slot, path, HitList::kFirst);
  if (list.hits().empty()) return none;
  const Hit& first = list.hits().front();
  return {m_store.object(first.key.slot), first.moment.toDouble(),
          Vector::fromFixed(path.sweep().before(first.moment))};
}

}  // namespace df
