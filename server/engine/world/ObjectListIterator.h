// Walks an ObjectList and skips Objects that are gone (book, Listing 4.43).
//
//     ObjectListIterator li(&list);
//     for (li.first(); !li.isDone(); li.next()) use(li.currentObject());
//
// The loop's body may delete any Object. Entries appended to the list meanwhile are visited too.
#pragma once

#include "ObjectList.h"

namespace df {

class ObjectListIterator {
 public:
  /// Start at the first entry. The list must outlive the iterator; null is an empty list.
  ObjectListIterator(const ObjectList* p_list) : m_p_list(p_list) {}

  /// On to another list, from its first entry on.
  void setList(const ObjectList* p_list) {
    m_p_list = p_list;
    m_index = 0;
  }
  /// Back to the first entry.
  void first() { m_index = 0; }
  /// On to the last entry.
  void last() { m_index = m_p_list != nullptr && !m_p_list->isEmpty() ? m_p_list->getCount() - 1 : 0; }
  /// On to the next entry.
  void next() { ++m_index; }
  /// True if no living Object is left at or after the current entry.
  bool isDone() const;
  /// The current Object: the first living one at or after the current entry. Null if done.
  Object* currentObject() const;

 private:
  int firstLiving() const;

  const ObjectList* m_p_list;
  mutable int m_index = 0;  // currentObject() moves it over dead entries
};

}  // namespace df
