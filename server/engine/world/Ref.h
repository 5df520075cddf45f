// A reference to an Object that becomes null when the Object is gone.
//
//   class Missile : public df::Object {
//     df::Ref<Saucer> m_target;  // = p_saucer, some time
//     …
//     if (m_target) steerTo(m_target->getPosition());
//   };
//
// A Ref reads as null once the Object was deleted or removed from the world, even if another Object has taken
// its place in memory, and once the world itself is gone. It stays null if a removed Object is inserted
// again. Like an ObjectList, it holds a handle, not only a pointer.
#pragma once

#include <cstddef>
#include <type_traits>

#include "detail/WorldView.h"

namespace df {

class Object;
class WorldStore;

/// The part of a Ref that does not depend on its type: checks whether the Object is still in its world.
class RefBase {
 public:
  RefBase() = default;
  explicit RefBase(const Object* p_o);
  RefBase(const RefBase& other);
  RefBase(RefBase&& other) noexcept;
  RefBase& operator=(RefBase other) noexcept;
  ~RefBase();

  /// True if the Object is still in its world.
  bool isInWorld() const;

 private:
  WorldStore* m_p_store = nullptr;  // reference-counted; null for a null reference
  ObjectKey m_key;
};

template <class T>
class Ref {
 public:
  /// A null reference.
  Ref() = default;
  Ref(std::nullptr_t) {}
  /// Refers to an Object in the world. If it is not in the world, the Ref reads as null until it is inserted.
  Ref(T* p_o) : m_base(p_o), m_p_object(p_o) {}
  /// Converts a reference to an Object to a reference to its base class.
  template <class U, class = std::enable_if_t<std::is_convertible_v<U*, T*>>>
  Ref(const Ref<U>& other) : m_base(other.m_base), m_p_object(other.m_p_object) {}

  /// Returns the Object; null if it is gone.
  T* get() const { return m_base.isInWorld() ? m_p_object : nullptr; }
  T* operator->() const { return get(); }
  T& operator*() const { return *get(); }
  explicit operator bool() const { return m_base.isInWorld(); }

  /// True also if both Objects are gone, because both references are null.
  friend bool operator==(const Ref& a, const Ref& b) { return a.get() == b.get(); }
  friend bool operator==(const Ref& a, const Object* p_b) { return a.get() == p_b; }
  friend bool operator==(const Ref& a, std::nullptr_t) { return !a; }
#if __cplusplus < 202002L
  friend bool operator!=(const Ref& a, const Ref& b) {
    return !(a == b);
  }
  friend bool operator!=(const Ref& a, const Object* p_b) {
    return !(a == p_b);
  }
  friend bool operator!=(const Ref& a, std::nullptr_t) {
    return static_cast<bool>(a);
  }
  friend bool operator==(std::nullptr_t, const Ref& a) {
    return !a;
  }
  friend bool operator!=(std::nullptr_t, const Ref& a) {
    return static_cast<bool>(a);
  }
#endif

 private:
  template <class U>
  friend class Ref;

  RefBase m_base;
  T* m_p_object = nullptr;
};

}  // namespace df
