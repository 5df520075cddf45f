// The part of World that is about Objects: who is in it, who goes, and what can be seen of it.

#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/CollisionRule.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Interests.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

// Coming and going.

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
  if (!owns(p_o)) return -1;
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
    if (m_unowned.insert(p_o->getType()).second) {
      log("Marked for deletion, but not made with new, so only removed: object of type " + p_o->getType());
    }
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
  m_refused.clear();
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
  m_game_over = true;  // for whoever runs the loop; GM.startUp() begins anew
}

// Who is there.

Object* World::find(ObjectKey key) const {
  return m_p_store->find(key);
}

const MoverStats& World::moverStats() const {
  return m_p_store->grid().moverStats();
}

int World::getObjectCount() const {
  return m_p_store->countInWorld();
}

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
  return collect([&](auto s) {
    return m_p_store->has(s, WorldStore::kActive) && m_p_store->object(s)->getType() == type;
  });
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

// Moving.

ObjectList World::getCollisions(const Object* p_o, Vector where) const {
  ObjectList list;
  const auto target = toFixed(where);
  if (p_o == nullptr || p_o->m_p_store != m_p_store || !target) return list;
  std::vector<ObjectKey> keys;
  const FixedBox box = m_p_store->worldBox(p_o->m_slot, *target);
  m_p_store->touching(box, p_o->m_slot, keys);
  keepMet(*m_p_store, p_o->m_slot, box, keys);
  for (const ObjectKey key : keys) list.append(m_p_store, key);
  return list;
}

void World::setSweptCollisions(bool swept) {
  m_p_store->setAllSwept(swept);
}

bool World::getSweptCollisions() const {
  return m_p_store->isAllSwept();
}

int World::moveObject(Object* p_o, Vector where) {
  if (!owns(p_o)) return -1;
  const auto target = toFixed(where);
  if (!target) {
    refuse(p_o->getType(), "moveObject");
    return -1;
  }
  const Scope scope(*this);
  return m_mover->move(p_o->key(), *target);
}

// Boundary, views and players.

int World::setBoundary(Box boundary) {
  if (m_views->setBoundary(boundary) == 0) return 0;
  refuse("WorldManager", "setBoundary");
  return -1;
}

Box World::getBoundary() const {
  return fromFixed(m_views->boundary());
}

int World::setWindow(int width, int height) {
  return m_views->setWindow(width, height);
}

int World::getWindowWidth() const {
  return m_views->width();
}

int World::getWindowHeight() const {
  return m_views->height();
}

Box World::getView() const {
  const Vector corner = Vector::fromFixed(m_views->cornerOf(getPlayer(m_input_player)));
  return {corner, static_cast<double>(m_views->width()), static_cast<double>(m_views->height())};
}

int World::setView(Box view) {
  const auto corner = toFixed(view.getCorner());
  if (!corner) {
    refuse("WorldManager", "setView");
    return -1;
  }
  m_views->setCorner(getPlayer(m_input_player), *corner);
  return 0;
}

int World::setViewPosition(Vector centre) {
  const auto position = toFixed(centre);
  if (!position) {
    refuse("WorldManager", "setViewPosition");
    return -1;
  }
  m_views->centre(getPlayer(m_input_player), *position);
  return 0;
}

int World::setViewFollowing(Object* p_o) {
  return m_views->follow(getPlayer(m_input_player), p_o);
}

Object* World::getViewFollowing() const {
  return find(m_views->followed(getPlayer(m_input_player)));
}

std::vector<Player*> World::getPlayers() const {
  std::vector<Player*> players;
  for (const auto& [id, p_player] : m_views->players()) players.push_back(p_player.get());
  return players;
}

Player* World::getPlayer(std::uint32_t id) const {
  return m_views->player(id);
}

}  // namespace df
