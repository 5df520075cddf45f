// A list of Objects that outlives them (book, Listing 4.39).
//
// The list holds handles, not pointers: an Object that was deleted, or removed from the world, then reads as
// null, even if another Object has taken its place in memory. Up to 16 entries need no allocation; there is
// no upper limit. All entries belong to one world.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "Object.h"
#include "detail/WorldView.h"

namespace df {

class Object;
class WorldStore;

class ObjectList {
 public:
  /// Number of entries that need no allocation.
  static constexpr int kInline = 16;

  ObjectList() = default;
  /// An ObjectList can be copied and moved.
  ObjectList(const ObjectList& other);
  ObjectList(ObjectList&& other) noexcept;
  ObjectList& operator=(ObjectList other) noexcept;
  ~ObjectList();

  /// Appends an Object, which may be in the list more than once. Returns 0, or -1 for null and for an Object
  /// of another world than that of the entries.
  int insert(Object* p_o);
  /// Removes the first entry of this Object; the others keep their order. Returns 0; -1 if none was listed.
  int remove(const Object* p_o);
  /// Removes all entries.
  void clear();

  /// Returns the number of entries, including those of Objects that are gone.
  int getCount() const { return m_count; }
  bool isEmpty() const { return m_count == 0; }
  /// Always false, because the list grows. (The book's list has a fixed size.)
  bool isFull() const { return false; }

  /// Returns entry `index`; null if the Object is gone or `index` is not in 0 … getCount()-1.
  Object* operator[](int index) const;

  /// True if both lists have equal entries in equal order.
  friend bool operator==(const ObjectList& a, const ObjectList& b);
  friend bool operator!=(const ObjectList& a, const ObjectList& b) { return !(a == b); }

  /// Appends all entries of `other`; does nothing if these belong to another world.
  ObjectList& operator+=(const ObjectList& other);
  friend ObjectList operator+(ObjectList a, const ObjectList& b) { return a += b; }

 private:
  friend class ObjectRegistry;
  const ObjectKey* keys() const { return m_count <= kInline ? m_few.data() : m_many.data(); }
  ObjectKey* keys() { return m_count <= kInline ? m_few.data() : m_many.data(); }
  void append(WorldStore* p_store, ObjectKey key);

  WorldStore* m_p_store = nullptr;  // reference-counted; null before the first entry
  int m_count = 0;
  std::array<ObjectKey, kInline> m_few;
  std::vector<ObjectKey> m_many;  // holds all entries once there are more than kInline
};

/// Walks an ObjectList and skips Objects that are gone (book, Listing 4.43).
///
///     ObjectListIterator li(&list);
///     for (li.first(); !li.isDone(); li.next()) use(li.currentObject());
///
/// The loop's body may delete any Object. Entries appended during the loop are visited too.
class ObjectListIterator {
 public:
  /// Starts at the first entry. The list must outlive the iterator; null is an empty list.
  ObjectListIterator(const ObjectList* p_list) : m_p_list(p_list) {}

  /// Moves to the first entry of another list.
  void setList(const ObjectList* p_list) {
    m_p_list = p_list;
    m_index = 0;
  }
  /// Moves back to the first entry.
  void first() { m_index = 0; }
  /// Moves to the last entry.
  void last() { m_index = m_p_list != nullptr && !m_p_list->isEmpty() ? m_p_list->getCount() - 1 : 0; }
  /// Moves to the next entry.
  void next() { ++m_index; }
  /// True if no living Object is left at or after the current entry.
  bool isDone() const { return m_p_list == nullptr || firstLiving() >= m_p_list->getCount(); }
  /// Returns the current Object: the first living one at or after the current entry. Null if done.
  Object* currentObject() const { return isDone() ? nullptr : (*m_p_list)[m_index = firstLiving()]; }

 private:
  int firstLiving() const {
    int i = m_index;
    while (i < m_p_list->getCount() && (*m_p_list)[i] == nullptr) ++i;
    return i;
  }

  const ObjectList* m_p_list;
  mutable int m_index = 0;  // mutable, because currentObject() skips entries of Objects that are gone
};

}  // namespace df
