#include "physics/body/BodyEvents.h"

#include <algorithm>

#include "engine/world/EventCollision.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/Body.h"
#include "physics/body/EventContactEnd.h"
#include "physics/body/SoftObject.h"

namespace naiad::physics {

namespace {

bool hearsEnds(const WorldStore& store, ObjectKey key) {
  if (!store.handlesEvents(key.slot) || !store.has(key.slot, WorldStore::kBody)) return false;
  const Object* p_object = store.object(key.slot);
  if (const auto* p_body = dynamic_cast<const df::Body*>(p_object)) return p_body->hasContactEnds();
  const auto* p_soft = dynamic_cast<const df::SoftBody*>(p_object);
  return p_soft != nullptr && p_soft->hasContactEnds();
}

void sendContactEnd(World& world, const BodyContact& contact) {
  const WorldStore& store = world.store();
  const df::EventContactEnd event(store.object(contact.first.slot), store.object(contact.second.slot));
  world.events().nameClassOf(event);
  if (hearsEnds(store, contact.first)) {
    world.events().runHandler(contact.first, *event.getObject1(), event);
    if (!store.isCurrentUnchecked(contact.first) || !store.isCurrentUnchecked(contact.second)) return;
  }
  if (hearsEnds(store, contact.second)) world.events().runHandler(contact.second, *event.getObject2(), event);
}

}  // namespace

void sendContactEvents(World& world, std::vector<BodyContact>& contacts) {
  const auto isEarlier = [](const BodyContact& a, const BodyContact& b) {
    if (a.time != b.time) return a.time < b.time;
    if (a.first_order != b.first_order) return a.first_order < b.first_order;
    return a.second_order < b.second_order;
  };
  if (!std::is_sorted(contacts.begin(), contacts.end(), isEarlier))
    std::stable_sort(contacts.begin(), contacts.end(), isEarlier);
  const WorldStore& store = world.store();
  for (const BodyContact& contact : contacts) {
    if (!store.isCurrent(contact.first) || !store.isCurrent(contact.second)) continue;
    if (!contact.is_begin) {
      sendContactEnd(world, contact);
      continue;
    }
    const std::uint32_t slot = contact.first.slot;
    df::EventCollision event(store.object(slot), store.object(contact.second.slot),
                             Vector::fromFixed(store.position(slot)));
    event.setImpulse(contact.impulse);
    world.events().sendToBoth(contact.first, contact.second, event);
  }
}

}  // namespace naiad::physics
