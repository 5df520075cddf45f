// Players' declared controls at work on their Objects; what the tables mean is in shared/replica/Steering.h.
#pragma once

#include "engine/world/Player.h"
#include "shared/values/Keyboard.h"

namespace df {

class Mover;

class ControlApplier {
 public:
  /// The tick's part for all players with controls, between the step event and the first input.
  static void beginTick(Mover& mover);
  /// The part of one key, just before its event. Return whether the player's table handled it.
  static bool handleKey(Mover& mover, Player& player, Keyboard::Key key, EventKeyboardAction action);

 private:
  class Steered;
};

}  // namespace df
