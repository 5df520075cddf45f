// Applies players' declared controls to their Objects. shared/replica/Steering.h documents the tables.
#pragma once

#include "engine/world/Player.h"
#include "shared/values/Keyboard.h"

namespace df {

class Mover;

class ControlApplier {
 public:
  /// Starts the tick for all players with controls, between the step event and the first input.
  static void beginTick(Mover& mover);
  /// Applies one key, just before its event. Returns whether the player's table handled it.
  static bool handleKey(Mover& mover, Player& player, Keyboard::Key key, EventKeyboardAction action);

 private:
  class SteeringTarget;
};

}  // namespace df
