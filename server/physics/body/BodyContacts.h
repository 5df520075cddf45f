// Which HARD bodies and Objects touch, whichever solver found it: a body that changes its solver gets neither
// a second EventCollision for what it lies on, nor misses the EventContactEnd.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyState.h"

namespace naiad::physics {

class BodyContacts {
 public:
  /// A tick begins.
  void beginTick();
  /// What a solver found; from each in the order of time. What is known already changes nothing.
  void add(const BodyContact& contact);
  /// The body or obstacle is gone: its contacts end with this tick.
  void expire(df::ObjectKey key) { expireIn(key, 1, nullptr); }
  /// The same for what this solver found.
  void expire(df::ObjectKey key, BodySolver by) { expireIn(key, 1, &by); }
  /// The body was handed to another solver: its contacts end, unless that solver finds them soon.
  void handOver(df::ObjectKey key) { expireIn(key, kHandOverTicks, nullptr); }
  /// The tick ends: contacts that began or ended in it.
  std::vector<BodyContact>& finishTick();

  /// About the logarithm of how many touch something.
  bool isTouching(df::ObjectKey key) const;
  bool isEmpty() const { return m_touching.empty(); }

 private:
  struct Touch {
    BodyContact contact;
    int ticks_left = 0;  // ticks until it ends, unless a solver finds it again; 0: it lasts
  };
  struct TouchCount {
    df::ObjectKey key;
    int count;  // of what it touches
  };
  static constexpr int kHandOverTicks = 3;  // ticks: a solver may find a contact a tick before it presses
  void expireIn(df::ObjectKey key, int ticks, const BodySolver* p_by);
  std::vector<Touch>::iterator find(const BodyContact& contact);
  void count(const BodyContact& contact, int by);
  std::vector<TouchCount>::const_iterator findCount(df::ObjectKey key) const;

  std::vector<Touch> m_touching;           // by the slots of the two
  std::vector<TouchCount> m_touch_counts;  // by keys
  std::vector<BodyContact> m_changes;
};

}  // namespace naiad::physics
