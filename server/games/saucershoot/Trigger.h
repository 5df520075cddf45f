// Whether a pilot keeps the trigger pulled: the space bar.
//
// A terminal may lose the moment a key goes up (the window loses the focus, say), so the trigger is also let
// go when the pilot's keyboard has been silent for a while: no ship shoots for ever.
#pragma once

#include "EventKeyboard.h"

class Trigger {
 public:
  /// Ticks. Longer than a keyboard waits before its first repeat.
  static constexpr int kPatience = 36;

  /// Note what `event` says about the key.
  void key(const df::EventKeyboard& event);
  /// Call once a tick, before the keys of that tick.
  void step();

  bool isPulled() const { return m_pulled; }

 private:
  bool m_pulled = false;
  int m_idle = 0;
};
