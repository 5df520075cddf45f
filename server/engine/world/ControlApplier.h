// Applies players' declared controls to their Objects. shared/replica/Steering.h documents the tables.
#pragma once

#include "engine/world/Player.h"
#include "shared/values/Keyboard.h"

namespace df {

class Mover;

class ControlApplier {
 public:
  /// Starts a tick of all players with controls. Call between the step event and the first input.
  static void beginTick(Mover& mover);
  /// Applies one key. Call just before its event is sent. Returns true if the player's table handled the key.
  static bool handleKey(Mover& mover, Player& player, Keyboard::Key key, EventKeyboardAction action);

 private:
  class SteeringTarget;
};

}  // namespace df
