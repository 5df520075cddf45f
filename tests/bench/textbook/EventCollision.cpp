#include "Book.h"

namespace textbook {

EventCollision::EventCollision(Object* p_o1, Object* p_o2, Vector p) {
  setType(COLLISION_EVENT);
  m_p_obj1 = p_o1;
  m_p_obj2 = p_o2;
  m_pos = p;
}

Object* EventCollision::getObject1() const {
  return m_p_obj1;
}

Object* EventCollision::getObject2() const {
  return m_p_obj2;
}

}  // namespace textbook
