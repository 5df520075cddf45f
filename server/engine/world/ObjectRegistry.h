// Adds, removes, deletes and finds a world's Objects. WorldManager.h documents the functions that have the
// same names there.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "engine/world/Contact.h"
#include "engine/world/ObjectList.h"
#include "engine/world/WorldStore.h"
#include "shared/values/Vector.h"

namespace df {

class Interests;
class WorldLog;

class ObjectRegistry {
 public:
  /// The arguments must outlive this object.
  ObjectRegistry(WorldStore& store, Interests& interests, WorldLog& log)
      : m_store(store), m_interests(interests), m_log(log) {}

  WorldStore& store() const { return m_store; }
  WorldLog& log() const { return m_log; }
  /// True if the Object is in the world. The pointer may be to a deleted Object.
  bool owns(const Object* p_o) const;

  int insertObject(Object* p_o);
  int removeObject(Object* p_o);
  int markForDelete(Object* p_o);
  ObjectList getAllObjects(bool inactive = false) const;
  ObjectList objectsOfType(const std::string& type);
  ObjectList solidObjects() const;
  Object* objectWithId(int id) const;
  ObjectList getCollisions(const Object* p_o, Vector where) const;
  Contact firstContact(const Object* p_o, Vector where) const;
  /// Returns, in creation order, the Objects that `wanted` accepts. Its argument is a slot in collect(), an
  /// Object in pick().
  template <class Wanted>
  ObjectList collect(Wanted wanted) const {
    ObjectList list;
    const WorldStore::Walk walk(m_store);
    for (std::size_t i = 0; i < walk.size(); ++i) {
      const WorldStore::Slot s = walk[i];
      if (s != WorldStore::kNoSlot && wanted(s)) list.append(&m_store, m_store.key(s));
    }
    return list;
  }
  template <class Wanted>
  ObjectList pick(Wanted wanted) const {
    return collect([&](auto s) { return wanted(*m_store.object(s)); });
  }

  /// Returns the Objects marked for deletion, in order of their marks.
  const std::vector<ObjectKey>& marked() const { return m_deletions; }
  /// Deletes the marked Objects in order of their marks, and those that destructors mark.
  void deleteMarked();
  /// Deletes the Objects made with `new`, removes all others, and clears marks and records of logged types.
  void clear();

 private:
  void logMissingType(const std::string& type);

  WorldStore& m_store;
  Interests& m_interests;
  WorldLog& m_log;
  std::vector<ObjectKey> m_deletions;  // marked Objects, in order of their marks
  std::set<std::string> m_missing;     // types that objectsOfType() did not find
  std::set<std::string> m_unowned;     // logged types that were marked for deletion but not made with new
};

}  // namespace df
