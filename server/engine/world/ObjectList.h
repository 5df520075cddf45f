// A list of Objects that outlives them (book, Listing 4.39).
//
// The list holds handles, not pointers: an Object that was deleted, or removed from the world, reads as
// null from then on, even if another one has taken its place in memory. Up to 16 entries live inside the
// list without any allocation; there is no upper limit. All entries belong to one world.
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
  /// Entries that need no allocation.
  static constexpr int kInline = 16;

  ObjectList() = default;
  /// Copies and moves like a value.
  ObjectList(const ObjectList& other);
  ObjectList(ObjectList&& other) noexcept;
  ObjectList& operator=(const ObjectList& other);
  ObjectList& operator=(ObjectList&& other) noexcept;
  ~ObjectList();

  /// Append. An Object may be in the list more than once. Return 0, or -1 for null and for an Object of
  /// another world than those already listed.
  int insert(Object* p_o);
  /// Take out the first entry of this Object; the order of the others stays. Return 0, or -1 if it is
  /// not in the list.
  int remove(const Object* p_o);
  /// Take out everything.
  void clear();

  /// Entries, those of dead Objects included.
  int getCount() const { return m_count; }
  bool isEmpty() const { return m_count == 0; }  ///< No entries.
  /// Never: the list grows. (The book's list has a fixed size.)
  bool isFull() const { return false; }

  /// Entry `index`; null if the Object is gone or `index` is not in 0 … getCount()-1.
  Object* operator[](int index) const;

  /// The same Objects in the same order?
  friend bool operator==(const ObjectList& a, const ObjectList& b);
  friend bool operator!=(const ObjectList& a, const ObjectList& b) { return !(a == b); }

  /// Append all entries of `other`; entries of another world are left out.
  ObjectList& operator+=(const ObjectList& other);
  friend ObjectList operator+(ObjectList a, const ObjectList& b) { return a += b; }

 private:
  friend class World;
  const ObjectKey* keys() const { return m_count <= kInline ? m_few.data() : m_many.data(); }
  ObjectKey* keys() { return m_count <= kInline ? m_few.data() : m_many.data(); }
  void append(WorldStore* p_store, ObjectKey key);

  WorldStore* m_p_store = nullptr;  // counted; null while the list never had an entry
  int m_count = 0;
  std::array<ObjectKey, kInline> m_few;
  std::vector<ObjectKey> m_many;  // holds all entries once there are more than kInline
};

}  // namespace df

#include "ObjectListIterator.h"  // IWYU pragma: keep: games expect it to come along
