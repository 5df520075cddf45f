// Which of a pilot's keys are held down.
//
// Keys arrive as events: pressed, perhaps "still down" every now and then, released. A terminal may lose the
// last one (the window loses the focus, say), so a key is also let go when the pilot's keyboard has been
// silent for a while: no ship flies off for ever.
#pragma once

#include "EventKeyboard.h"

class Controls {
 public:
  /// Note what `event` says about the keys.
  void key(const df::EventKeyboard& event);
  /// Call once a tick, before the keys of that tick.
  void step();

  /// -1 left, 1 right, 0 neither; the key pressed last wins.
  int horizontal() const { return m_horizontal.direction; }
  /// -1 up, 1 down, 0 neither.
  int vertical() const { return m_vertical.direction; }
  bool isFiring() const { return m_firing; }

 private:
  /// Ticks. Longer than a keyboard waits before its first repeat.
  static constexpr int kPatience = 36;

  /// A key that goes down and up within one tick still counts in that tick, so letting go waits for step().
  struct Lever {
    int direction = 0;
    bool let_go = false;

    void pull(int to, bool down);
    void step();
  };

  Lever m_horizontal;
  Lever m_vertical;
  bool m_firing = false;
  int m_silence = 0;
};
