// The state of a pilot's trigger, the space bar.
//
// A terminal may miss the release of a key (when the window loses the focus, for example). So the trigger is
// also released when the pilot's keyboard has been silent for a while, and no ship shoots endlessly.
#pragma once

#include "EventKeyboard.h"

class Trigger {
 public:
  /// Ticks; longer than a keyboard's delay before its first repeat.
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
