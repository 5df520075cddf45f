#include "physics/body/BodyEvents.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/world/EventCollision.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/Body.h"
#include "physics/body/EventContactEnd.h"
#include "physics/body/SoftObject.h"

namespace naiad::physics {

namespace {

constexpr std::uint8_t kFirst = 1, kSecond = 2;  // bits of BodyContact::missed

bool hearsEnds(const WorldStore& store, ObjectKey key) {
  if (!store.isCurrent(key) || !store.handlesEvents(key.slot) || !store.has(key.slot, WorldStore::kBody))
    return false;
  const Object* p_object = store.object(key.slot);
  if (const auto* p_body = dynamic_cast<const df::Body*>(p_object)) return p_body->hasContactEnds();
  const auto* p_soft = dynamic_cast<const df::SoftBody*>(p_object);
  return p_soft != nullptr && p_soft->hasContactEnds();
}

void sendContactEnd(World& world, const BodyContact& contact, std::uint8_t missed) {
  const WorldStore& store = world.store();
  const auto sendTo = [&](ObjectKey key) {
    if (!hearsEnds(store, key)) return;
    const df::EventContactEnd event(store.find(contact.first), store.find(contact.second));
    world.events().nameClassOf(event);
    world.events().runHandler(key, *store.object(key.slot), event);
  };
  if ((missed & kFirst) == 0) sendTo(contact.first);
  if ((missed & kSecond) == 0) sendTo(contact.second);
}

// Returns the receivers that missed the event.
std::uint8_t sendCollision(World& world, const BodyContact& contact) {
  const WorldStore& store = world.store();
  const std::uint32_t slot = contact.first.slot;
  if (!store.isCurrent(contact.first) || !store.isCurrent(contact.second)) return kFirst | kSecond;
  df::EventCollision event(store.object(slot), store.object(contact.second.slot),
                           Vector::fromFixed(store.position(slot)));
  event.setImpulse(contact.impulse);
  std::uint8_t missed = store.has(slot, WorldStore::kActive) ? 0 : kFirst;
  if (store.handlesEvents(slot)) {
    world.events().runHandler(contact.first, *event.getObject1(), event);
    if (!store.isCurrentUnchecked(contact.first) || !store.isCurrentUnchecked(contact.second))
      return missed | kSecond;
  }
  if (!store.has(contact.second.slot, WorldStore::kActive)) missed |= kSecond;
  if (store.handlesEvents(contact.second.slot))
    world.events().runHandler(contact.second, *event.getObject2(), event);
  return missed;
}

// Returns the receivers that missed the begin of the contact that ends with the entry `end`.
std::uint8_t missedBefore(const std::vector<BodyContact>& contacts, std::size_t end) {
  for (std::size_t i = end; i-- > 0;) {
    const BodyContact& contact = contacts[i];
    if (contact.is_begin && contact.first == contacts[end].first && contact.second == contacts[end].second)
      return contact.missed;
  }
  return contacts[end].missed;
}

// Makes the times of each pair's changes ascend in their order, so that sorting by time keeps it: a block's
// Object may end one contact of a body and begin another one at an earlier time of the tick.
void ascendInPairs(std::vector<BodyContact>& contacts) {
  std::vector<std::size_t> sorted(contacts.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  const auto pairOf = [&](std::size_t i) {
    return std::pair(contacts[i].first_order, contacts[i].second_order);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::size_t a, std::size_t b) { return pairOf(a) < pairOf(b); });
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (pairOf(sorted[i]) == pairOf(sorted[i - 1]))
      contacts[sorted[i]].time = std::max(contacts[sorted[i]].time, contacts[sorted[i - 1]].time);
  }
}

}  // namespace

bool sendContactEvents(World& world, std::vector<BodyContact>& contacts) {
  const auto isEarlier = [](const BodyContact& a, const BodyContact& b) {
    if (a.time != b.time) return a.time < b.time;
    if (a.first_order != b.first_order) return a.first_order < b.first_order;
    return a.second_order < b.second_order;
  };
  if (!std::is_sorted(contacts.begin(), contacts.end(), isEarlier)) {
    ascendInPairs(contacts);
    std::stable_sort(contacts.begin(), contacts.end(), isEarlier);
  }
  bool has_missed = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    BodyContact& contact = contacts[i];
    if (contact.is_begin) {
      contact.missed = sendCollision(world, contact);
      has_missed = has_missed || contact.missed != 0;
    } else {
      sendContactEnd(world, contact, has_missed ? missedBefore(contacts, i) : contact.missed);
    }
  }
  return has_missed;
}

}  // namespace naiad::physics
