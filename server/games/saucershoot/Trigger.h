// The state of a pilot's trigger, the space bar.
//
// A terminal may miss the release of a key (for example when the window loses the focus). So the trigger is
// also released when no key of the pilot has arrived for a while, so that no ship shoots endlessly.
#pragma once

#include "EventKeyboard.h"

class Trigger {
 public:
  /// Ticks without a key after which the trigger is released; longer than a keyboard's delay before repeats.
  static constexpr int kPatience = 36;

  /// Updates the state from a key event.
  void key(const df::EventKeyboard& event);
  /// Call once a tick, before the keys of that tick.
  void step();

  bool isPulled() const { return m_pulled; }

 private:
  bool m_pulled = false;
  int m_idle = 0;
};
