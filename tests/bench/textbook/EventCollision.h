// Listing 4.105 of the Dragonfly book, without the setters.
#pragma once

#include "Event.h"
#include "Object.h"
#include "Vector.h"

namespace textbook {

const std::string COLLISION_EVENT = "df::collision";

class EventCollision : public Event {
 private:
  Vector m_pos;      // Where collision occurred.
  Object* m_p_obj1;  // Object moving, causing collision.
  Object* m_p_obj2;  // Object being collided with.

 public:
  EventCollision(Object* p_o1, Object* p_o2, Vector p);

  Object* getObject1() const;
  Object* getObject2() const;
};

}  // namespace textbook
