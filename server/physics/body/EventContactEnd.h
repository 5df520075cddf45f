// Sent to a Body or SoftBody that asked for it (setContactEnds) when a contact has ended.
//
// As an EventCollision it comes after all bodies have moved, in the order of (time, ids); a bounce within a
// tick begins a contact and ends it.
#pragma once

#include "Event.h"
#include "Object.h"

namespace df {

/// Comes to those that ask: Body::setContactEnds.
inline const EventType CONTACT_END_EVENT("df-contact-end");

class EventContactEnd : public Event {
 public:
  /// Without Objects.
  EventContactEnd() : EventContactEnd(nullptr, nullptr) {}
  /// The contact of `p_o1`, a Body or SoftBody, with `p_o2`.
  EventContactEnd(Object* p_o1, Object* p_o2) : Event(&CONTACT_END_EVENT), m_p_obj1(p_o1), m_p_obj2(p_o2) {}

  /// As they were in the collision event that began it.
  void setObject1(Object* p_new_o1) { m_p_obj1 = p_new_o1; }
  Object* getObject1() const { return m_p_obj1; }
  void setObject2(Object* p_new_o2) { m_p_obj2 = p_new_o2; }
  Object* getObject2() const { return m_p_obj2; }

 private:
  Object* m_p_obj1;
  Object* m_p_obj2;
};

}  // namespace df
