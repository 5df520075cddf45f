// The contacts of HARD bodies and Objects, independent of the solver that found them. A body that changes its
// solver neither gets a second EventCollision for a lasting contact, nor misses the EventContactEnd.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "physics/body/BodyState.h"
#include "physics/geometry/Reserve.h"

namespace naiad::physics {

class BodyContacts {
 public:
  /// Begins a tick.
  void beginTick();
  /// Reserves memory for this many further contacts.
  void expect(std::size_t contacts) {
    if (contacts > m_changes.capacity()) m_touching.reserve(m_touching.size() + contacts);
    reserveFor(m_changes, contacts);
  }
  /// Adds the start or end of a contact. Each solver adds its own in order of time. Ignores known ones.
  void add(const BodyContact& contact);
  /// Call when the body or obstacle is gone: its contacts end with this tick.
  void expire(ObjectKey key) { expireIn(key, 1, nullptr); }
  /// Like expire(key), but only for contacts found by this solver.
  void expire(ObjectKey key, BodySolver by) { expireIn(key, 1, &by); }
  /// Call when the body changed its solver: its contacts end soon, unless the new solver finds them.
  void handOver(ObjectKey key) { m_handed_over.push_back(key); }
  /// Ends the tick. Returns the contacts that began or ended in it.
  std::vector<BodyContact>& finishTick();

  bool isTouching(ObjectKey key) const;
  bool isEmpty() const { return m_touching.empty(); }

 private:
  struct Touch {
    BodyContact contact;
    int ticks_left = 0;  // ticks until the contact ends, unless a solver finds it again; 0: it lasts
  };
  struct TouchCount {  // indexed by slot
    std::uint32_t generation = 0;
    int count = 0;  // number of contacts
  };
  static constexpr int kHandOverTicks = 3;  // ticks to wait: bodies may press a tick after contact
  void expireIn(ObjectKey key, int ticks, const BodySolver* p_by);
  static std::uint64_t keyOf(const BodyContact& contact) {
    return std::uint64_t{contact.first.slot} << 32 | contact.second.slot;
  }
  static std::uint64_t nameOf(ObjectKey key) { return std::uint64_t{key.slot} << 32 | key.generation; }
  void applyHandOvers();
  void count(const BodyContact& contact, int by);

  std::unordered_map<std::uint64_t, Touch> m_touching;  // unordered; sendContactEvents() sorts the changes
  std::vector<TouchCount> m_counts;
  std::unordered_map<std::uint64_t, int> m_other_counts;  // by nameOf(), if the slot in m_counts is taken
  std::vector<ObjectKey> m_handed_over;  // bodies handed over in this tick, not yet applied to m_touching
  bool m_has_expiring = false;
  std::vector<BodyContact> m_changes;
};

}  // namespace naiad::physics
