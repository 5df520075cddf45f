// Pauses the game when its key is pressed, and lets it go on when it is pressed again: no step events,
// nothing moves, no input but to Pause objects; the picture stays.
//
// With many players any of them can do it. (That it becomes a vote is up to the host.)
#pragma once

#include "EventKeyboard.h"
#include "Object.h"

#define DF_PAUSE_KEY df::Keyboard::PAUSE

namespace df {

class Pause : public Object {
 public:
  explicit Pause(int init_pause_key = DF_PAUSE_KEY);
  /// The game goes on.
  ~Pause() override;
  Pause(const Pause&) = delete;
  Pause& operator=(const Pause&) = delete;

  int eventHandler(const Event* p_e) override;

 private:
  int m_pause_key;
};

}  // namespace df
