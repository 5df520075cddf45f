// Copies of Objects, which games of the published engine keep in vectors and assign to members.

#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

Object::Object(const Object& other) : Object() {
  if (World* p_world = getWorld()) p_world->removeObject(this);
  resemble(other);
}

Object& Object::operator=(const Object& other) {
  if (this != &other) resemble(other);
  return *this;
}

void Object::resemble(const Object& other) {
  const WorldStore& from = *other.m_p_store;
  WorldStore& to = *m_p_store;
  const WorldStore::Slot source = other.m_slot;
  to.setPosition(m_slot, from.position(source));
  to.setBox(m_slot, from.box(source));
  to.setAltitude(m_slot, from.altitude(source));
  to.setSolidness(m_slot, from.solidness(source));
  for (const WorldStore::Flag flag :
       {WorldStore::kActive, WorldStore::kVisible, WorldStore::kNoSoft, WorldStore::kStaticLook,
        WorldStore::kSwept, WorldStore::kPrecise, WorldStore::kRestContacts, WorldStore::kMayMoveOut,
        WorldStore::kOnView}) {
    to.set(m_slot, flag, from.has(source, flag));
  }
  to.setVelocity(m_slot, from.velocity(source));
  to.setAcceleration(m_slot, from.acceleration(source));
  to.setDerived(m_slot, from.has(source, WorldStore::kDerive));
  to.setFrames(m_slot, from.frames(source));
  // All but the interests, which belong to the Object that registered them.
  const ObjectProfile& profile = *other.m_p_profile;
  m_p_profile->type = profile.type;
  m_p_profile->speed = profile.speed;
  m_p_profile->direction = profile.direction;
  m_p_profile->direction_is_velocity = profile.direction_is_velocity;
  if (other.m_p_extras == nullptr && m_p_extras == nullptr) return;
  const ObjectExtras plain;
  const ObjectExtras& theirs = other.m_p_extras != nullptr ? *other.m_p_extras : plain;
  extras().animation = theirs.animation;
  extras().shape = theirs.shape;
  extras().is_centered = theirs.is_centered;
  extras().avoids_collisions = theirs.avoids_collisions;
  animate();
}

}  // namespace df
