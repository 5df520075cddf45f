#include "engine/world/ObjectListIterator.h"

namespace df {

int ObjectListIterator::firstLiving() const {
  int i = m_index;
  while (m_p_list != nullptr && i < m_p_list->getCount() && (*m_p_list)[i] == nullptr) ++i;
  return i;
}

// Asking does not move: if the loop's body has just deleted the current Object, next() must still go to
// the entry behind it and not one further.
bool ObjectListIterator::isDone() const {
  return m_p_list == nullptr || firstLiving() >= m_p_list->getCount();
}

Object* ObjectListIterator::currentObject() const {
  if (isDone()) return nullptr;
  m_index = firstLiving();
  return (*m_p_list)[m_index];
}

}  // namespace df
