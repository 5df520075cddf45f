// How an event reaches an Object's eventHandler(): inline, for a crowded world does little else.
#pragma once

#include <exception>

#include "engine/world/ActivityPage.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

inline void World::nameClassOf(const Event& event) {
  if (m_p_page != nullptr && classOf(event) != m_named_event) nameEvent(event);
}

inline void World::runHandler(ObjectKey key, Object& object, const Event& event) {
  ++m_handlers;
  try {
    const ActivityScope running(*m_p_activity, classOf(object), classOf(event));
    object.eventHandler(&event);
  } catch (const std::exception& e) {
    quarantine(key, e.what());
  } catch (...) {
    quarantine(key, "an exception of unknown type");
  }
  --m_handlers;
  if (m_shutdown_pending) finishShutDown();
}

/// Send a collision to the mover, then to the other, except to an Object that is gone meanwhile, inactive or
/// without a handler. Both must be in the world. Return whether the mover still is.
inline bool sendToBoth(World& world, ObjectKey mover, ObjectKey other, const EventCollision& event) {
  const WorldStore& store = world.store();
  if (store.hears(mover.slot)) {
    world.runHandler(mover, *event.getObject1(), event);
    if (!store.isStill(mover)) return false;
    if (!store.isStill(other)) return true;
  }
  if (store.hears(other.slot)) {
    world.runHandler(other, *event.getObject2(), event);
    if (!store.isStill(mover)) return false;
  }
  return true;
}

}  // namespace df
