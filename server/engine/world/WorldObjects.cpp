// The part of World in which Objects come, move and go.

#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/ClassName.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Interests.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

bool World::owns(const Object* p_o) const {
  // Its slot may be another one's by now, if the game holds a pointer to what it has deleted.
  return p_o != nullptr && p_o->m_p_store == m_p_store && m_p_store->has(p_o->m_slot, WorldStore::kInWorld) &&
         m_p_store->object(p_o->m_slot) == p_o;
}

int World::insertObject(Object* p_o) {
  if (p_o == nullptr || p_o->m_p_store != m_p_store || m_p_store->object(p_o->m_slot) != p_o) return -1;
  if (!owns(p_o)) m_p_store->enter(p_o->m_slot);
  return 0;
}

int World::removeObject(Object* p_o) {
  if (!owns(p_o)) return -1;
  forget(p_o);
  return 0;
}

void World::forget(Object* p_o) {
  m_interests->dropAll(*p_o);
  m_capture->forgetLook(p_o->m_slot);
  m_p_store->leave(p_o->m_slot);
}

int World::markForDelete(Object* p_o) {
  if (!owns(p_o)) {
    logOnce(p_o == nullptr ? "WM.markForDelete() of a null pointer"
                           : "WM.markForDelete() of an Object that is not in the world (any more)");
    return -1;
  }
  if (m_p_store->has(p_o->m_slot, WorldStore::kMarked)) return 0;
  m_p_store->set(p_o->m_slot, WorldStore::kMarked, true);
  m_deletions.push_back(p_o->key());
  return 0;
}

void World::deleteMarked() {
  // Destructors may mark more, which go in the same round.
  for (std::size_t i = 0; i < m_deletions.size(); ++i) {
    Object* p_o = find(m_deletions[i]);
    if (p_o == nullptr) continue;
    if (m_p_store->has(p_o->m_slot, WorldStore::kHeap)) {
      delete p_o;
      continue;
    }
    const std::string name = nameOf(*p_o);
    if (m_unowned.insert(name).second)
      log("Marked for deletion, but not made with new, so only removed: object of type " + name);
    removeObject(p_o);
  }
  m_deletions.clear();
}

// Destructors may make new Objects, which are deleted in the next round; a game that always makes more is
// not followed for ever.
void World::deleteAll() {
  constexpr int kRounds = 100;
  for (int round = 0; round < kRounds && m_p_store->countInWorld() > 0; ++round) {
    const WorldStore::Walk walk(*m_p_store);
    for (std::size_t i = 0; i < walk.size(); ++i) {
      const WorldStore::Slot s = walk[i];
      if (s == WorldStore::kNoSlot) continue;
      Object* p_o = m_p_store->object(s);
      if (m_p_store->has(s, WorldStore::kHeap)) {
        delete p_o;
      } else {
        removeObject(p_o);
      }
    }
  }
  m_p_store->closeGaps();
}

void World::shutDown() {
  if (isBusy()) {
    m_shutdown_pending = true;
    m_game_over = true;
    return;
  }
  const Scope scope(*this);
  deleteAll();
  m_deletions.clear();
  m_views->reset();
  m_input->clear();
  m_random = Random(m_seed);
  m_logged.clear();
  m_missing.clear();
  m_unowned.clear();
  m_help.clear();
  if (m_p_extras != nullptr) m_p_extras->reset();
  m_refusals = 0;
  m_step_count = 0;
  m_started = 0;
  m_looking_back = false;
  m_leavers.clear();
  m_game_over = false;
}

void World::finishShutDown() {
  if (isBusy() || !std::exchange(m_shutdown_pending, false)) return;
  shutDown();
  m_game_over = true;  // ends the running loop; GM.startUp() starts again
}

Object* World::find(ObjectKey key) const {
  return m_p_store->find(key);
}

const MoverStats& World::moverStats() const {
  return m_p_store->grid().moverStats();
}

int World::getObjectCount() const {
  return m_p_store->countInWorld();
}

void World::setSweptCollisions(bool swept) {
  m_p_store->setAllSwept(swept);
}

bool World::getSweptCollisions() const {
  return m_p_store->isAllSwept();
}

int World::moveObject(Object* p_o, Vector where) {
  if (!owns(p_o)) {
    logOnce("WM.moveObject() of " +
            std::string(p_o == nullptr ? "a null pointer" : "an Object that is not in the world (any more)"));
    return -1;
  }
  const auto target = toFixed(where);
  if (!target) {
    refuse(nameOf(*p_o), "moveObject");
    return -1;
  }
  const Scope scope(*this);
  return m_mover->move(p_o->key(), *target);
}

}  // namespace df
