// The contacts of bodies and Objects, whether a solver or BodySensors found them. A pair whose
// solver or solidness changes neither gets a second EventCollision for a lasting contact, nor misses the
// EventContactEnd.
#pragma once

#include <cstdint>
#include <optional>
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
  /// Ends the contact of a pair at this time, if there is one.
  void end(ObjectKey first, ObjectKey second, double time);

  // The following functions do not change the contacts of sensors, which BodySensors examines in each tick.

  /// Call when the body or obstacle takes no part any more, or is not HARD: its contacts end with this tick,
  /// unless they are found again in it.
  void expire(ObjectKey key) { m_lapses.push_back({key, 1, std::nullopt}); }
  /// Like expire(key), but only for contacts found by this solver.
  void expire(ObjectKey key, BodySolver by) { m_lapses.push_back({key, 1, by}); }
  /// Call when the body changed its solver: its contacts end soon, unless a solver finds them first.
  void handOver(ObjectKey key) { m_lapses.push_back({key, kHandOverTicks, std::nullopt}); }
  /// Like handOver(key), for the contact of a body that has stopped being a sensor.
  void handOver(ObjectKey first, ObjectKey second);

  /// Ends the tick. Returns the contacts that began or ended in it.
  std::vector<BodyContact>& finishTick();
  /// Call when the events of `contacts` were sent: remembers which receivers missed them.
  void noteMissed(const std::vector<BodyContact>& contacts);
  /// Ends all contacts of the Objects that are marked for deletion, of sensors too. Returns them.
  std::vector<BodyContact>& endMarked(const WorldStore& store);

  /// True if the body or Object has a contact with something that it pushes.
  bool isTouching(ObjectKey key) const;
  bool isEmpty() const { return m_touching.empty(); }

 private:
  struct Touch {
    BodyContact contact;
    int ticks_left = 0;  // ticks until the contact ends, unless it is found again; 0: it lasts
  };
  struct TouchCount {  // indexed by slot
    std::uint32_t generation = 0;
    int count = 0;  // number of contacts
  };
  struct Lapse {  // a body or obstacle whose contacts get `ticks_left`
    ObjectKey key;
    int ticks;
    std::optional<BodySolver> by;  // only contacts that this solver found
  };
  using Touches = std::unordered_map<std::uint64_t, Touch>;
  static constexpr int kHandOverTicks = 3;  // ticks to wait: bodies may press a tick after contact
  static std::uint64_t keyOf(ObjectKey first, ObjectKey second) {
    return std::uint64_t{first.slot} << 32 | second.slot;
  }
  static std::uint64_t nameOf(ObjectKey key) { return std::uint64_t{key.slot} << 32 | key.generation; }
  Touches::iterator find(ObjectKey first, ObjectKey second);
  Touches::iterator end(Touches::iterator at, double time);
  void applyLapses();
  void count(const BodyContact& contact, int by);

  Touches m_touching;  // unordered; sendContactEvents() sorts the changes
  std::vector<TouchCount> m_counts;
  std::unordered_map<std::uint64_t, int> m_other_counts;  // by nameOf(), if the slot in m_counts is taken
  std::vector<Lapse> m_lapses;                            // not yet applied to m_touching
  bool m_has_expiring = false;
  std::vector<BodyContact> m_changes;
};

}  // namespace naiad::physics
