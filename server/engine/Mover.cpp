#include "Mover.h"

#include "EventCollision.h"
#include "EventOut.h"
#include "Object.h"
#include "Views.h"
#include "World.h"
#include "WorldStore.h"

namespace df {

void Mover::moveAll() {
  WorldStore& store = m_world.store();
  const WorldStore::Walk walk(store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const WorldStore::Slot s = walk[i];
    if (s == WorldStore::kNoSlot) continue;
    if (store.velocity(s) == FixedVector{} && store.acceleration(s) == FixedVector{}) continue;
    if (store.has(s, WorldStore::kActive)) takeTurn(store.key(s));
  }
}

void Mover::takeTurn(ObjectKey key) {
  WorldStore& store = m_world.store();
  const WorldStore::Slot s = key.slot;
  const FixedVector velocity = store.velocity(s);
  bool blocked = false;
  if (velocity != FixedVector{}) {
    const FixedVector where = store.position(s) + velocity;
    if (WorldStore::isPosition(where)) {
      blocked = move(key, where) != 0;
    } else {
      m_world.refuse(store.object(s)->getType(), "update, at the end of the number range");
      blocked = true;
    }
    if (!store.isCurrent(key)) return;
    // Whether a velocity that a handler has just set will be blocked, nobody knows yet.
    if (store.velocity(s) != velocity) blocked = false;
  }
  FixedVector next = store.velocity(s);
  const FixedVector acceleration = store.acceleration(s);
  if (acceleration != FixedVector{} && WorldStore::isVelocity(next + acceleration)) {
    next = next + acceleration;
    store.set(s, WorldStore::kDerive, true);
  }
  store.settle(s, next, blocked);
}

int Mover::move(ObjectKey mover, FixedVector where) {
  if (m_depth >= kMaxDepth) return -1;
  std::vector<ObjectKey>& others = m_lists[m_depth];
  ++m_depth;
  bool free = true;
  const WorldStore& store = m_world.store();
  if (store.collides(mover.slot)) {
    others.clear();
    store.touching(store.worldBox(mover.slot, where), mover.slot, others);
    if (!others.empty()) free = collide(mover, where, others);
  }
  if (free) place(mover, where);
  --m_depth;
  return free ? 0 : -1;
}

// Return whether the mover may move.
bool Mover::collide(ObjectKey mover, FixedVector where, std::vector<ObjectKey>& others) {
  const WorldStore& store = m_world.store();
  bool free = true;
  for (const ObjectKey other : others) {
    if (!store.isCurrent(other)) continue;
    const EventCollision event(store.find(mover), store.find(other), Vector::fromFixed(where));
    m_world.deliver(mover, event);
    if (!store.isCurrent(mover)) return false;
    m_world.deliver(other, event);
    if (!store.isCurrent(mover)) return false;
    if (!store.isCurrent(other)) continue;
    const Solidness own = store.solidness(mover.slot);
    const Solidness its = store.solidness(other.slot);
    if (own == HARD && its == HARD) free = false;
    if (its == SOFT && store.has(mover.slot, WorldStore::kNoSoft)) free = false;
  }
  return free;
}

void Mover::place(ObjectKey mover, FixedVector where) {
  WorldStore& store = m_world.store();
  const Views& views = m_world.views();
  const bool was_inside = views.isInside(store.position(mover.slot));
  store.setPosition(mover.slot, where);
  if (store.has(mover.slot, WorldStore::kFollowed)) m_world.views().moved(mover, where);
  if (was_inside && !views.isInside(where)) m_world.deliver(mover, EventOut());
}

}  // namespace df
