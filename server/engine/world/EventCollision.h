// Sent to both Objects when a solid one moves onto another solid one (book, Listing 4.105).
//
// The mover gets the event first, then the other Object. No interest needs to be registered. If the first
// handler deletes either Object with `delete`, the second handler is not called, so both pointers are valid
// in every handler.
//
// Bodies (physics) get the event once when a contact begins, after all bodies have moved.
#pragma once

#include "Event.h"
#include "Object.h"
#include "Vector.h"

namespace df {

/// Type of EventCollision, which is sent without registration.
inline const EventType COLLISION_EVENT("df-collision");

class EventCollision : public Event {
 public:
  /// Makes a collision at (0,0) without Objects.
  EventCollision() : EventCollision(nullptr, nullptr, Vector()) {}
  /// Makes a collision that `p_o1` caused by moving onto `p_o2`. `p` is the target of the move (swept: p_o1's
  /// position just before the contact).
  EventCollision(Object* p_o1, Object* p_o2, Vector p)
      : Event(&COLLISION_EVENT), m_pos(p), m_p_obj1(p_o1), m_p_obj2(p_o2) {}

  /// The Object that moved, and so caused the collision.
  void setObject1(Object* p_new_o1) { m_p_obj1 = p_new_o1; }
  Object* getObject1() const { return m_p_obj1; }
  /// The Object that was collided with.
  void setObject2(Object* p_new_o2) { m_p_obj2 = p_new_o2; }
  Object* getObject2() const { return m_p_obj2; }
  /// Target of the move, not a point of contact. For swept moves, the mover's position just before contact.
  void setPosition(Vector new_pos) { m_pos = new_pos; }
  Vector getPosition() const { return m_pos; }
  /// Strength of the impact of bodies: mass · cell widths per tick, along the line of the impact. 0 if either
  /// Object is not a body, or is SOFT and so does not push.
  void setImpulse(double new_impulse) { m_impulse = new_impulse; }
  double getImpulse() const { return m_impulse; }

 private:
  Vector m_pos;
  double m_impulse = 0;
  Object* m_p_obj1;
  Object* m_p_obj2;
};

}  // namespace df
