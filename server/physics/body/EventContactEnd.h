// Event sent to a Body or SoftBody when a contact ends, if setContactEnds() was called for it.
//
// Like EventCollisions, these events are sent after all bodies have moved, ordered by time, then by ids. A
// bounce within a tick both begins and ends a contact. For each begin of a contact, an Object gets one end,
// also if the other Object is deleted, frozen, made inactive or SPECTRAL, or moved away. The contacts of an
// Object marked for deletion end in that tick, while it still exists; after `delete`, the event comes in the
// next tick.
#pragma once

#include "Event.h"
#include "Object.h"

namespace df {

/// Type of the event; it is sent only to a Body or SoftBody with setContactEnds().
inline const EventType CONTACT_END_EVENT("df-contact-end");

class EventContactEnd : public Event {
 public:
  /// Creates an event without Objects.
  EventContactEnd() : EventContactEnd(nullptr, nullptr) {}
  /// Creates the event for the contact of `p_o1`, a Body or SoftBody, with `p_o2`.
  EventContactEnd(Object* p_o1, Object* p_o2) : Event(&CONTACT_END_EVENT), m_p_obj1(p_o1), m_p_obj2(p_o2) {}

  /// The first and second Object, as in the collision event that began the contact. Null for one that is
  /// deleted or removed from the world.
  void setObject1(Object* p_new_o1) { m_p_obj1 = p_new_o1; }
  Object* getObject1() const { return m_p_obj1; }
  void setObject2(Object* p_new_o2) { m_p_obj2 = p_new_o2; }
  Object* getObject2() const { return m_p_obj2; }

 private:
  Object* m_p_obj1;
  Object* m_p_obj2;
};

}  // namespace df
