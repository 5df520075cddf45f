// Which HARD bodies and Objects touch, whichever solver found it: a body that changes its solver gets neither
// a second EventCollision for what it lies on, nor misses the EventContactEnd.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "physics/body/BodyState.h"
#include "physics/geometry/Reserve.h"

namespace naiad::physics {

class BodyContacts {
 public:
  /// A tick begins.
  void beginTick();
  /// Up to so many will be added: memory is taken once.
  void expect(std::size_t contacts) {
    if (contacts > m_changes.capacity()) m_touching.reserve(m_touching.size() + contacts);
    reserveFor(m_changes, contacts);
  }
  /// What a solver found; from each in the order of time. What is known already changes nothing.
  void add(const BodyContact& contact);
  /// The body or obstacle is gone: its contacts end with this tick.
  void expire(ObjectKey key) { expireIn(key, 1, nullptr); }
  /// The same for what this solver found.
  void expire(ObjectKey key, BodySolver by) { expireIn(key, 1, &by); }
  /// The body was handed to another solver: its contacts end, unless that solver finds them soon.
  void handOver(ObjectKey key) { m_handed_over.push_back(key); }
  /// The tick ends: contacts that began or ended in it.
  std::vector<BodyContact>& finishTick();

  bool isTouching(ObjectKey key) const;
  bool isEmpty() const { return m_touching.empty(); }

 private:
  struct Touch {
    BodyContact contact;
    int ticks_left = 0;  // ticks until it ends, unless a solver finds it again; 0: it lasts
  };
  struct TouchCount {  // by slot
    std::uint32_t generation = 0;
    int count = 0;  // of what it touches
  };
  static constexpr int kHandOverTicks = 3;  // ticks: a solver may find a contact a tick before it presses
  void expireIn(ObjectKey key, int ticks, const BodySolver* p_by);
  static std::uint64_t keyOf(const BodyContact& contact) {
    return std::uint64_t{contact.first.slot} << 32 | contact.second.slot;
  }
  static std::uint64_t nameOf(ObjectKey key) { return std::uint64_t{key.slot} << 32 | key.generation; }
  void applyHandOvers();
  void count(const BodyContact& contact, int by);

  std::unordered_map<std::uint64_t, Touch>
      m_touching;  // in no order: what changes is sorted by those who hear it
  std::vector<TouchCount> m_counts;
  std::unordered_map<std::uint64_t, int>
      m_other_counts;                    // of others in a slot that is counted already, by name
  std::vector<ObjectKey> m_handed_over;  // in this tick, and not yet looked for
  bool m_has_expiring = false;
  std::vector<BodyContact> m_changes;
};

}  // namespace naiad::physics
