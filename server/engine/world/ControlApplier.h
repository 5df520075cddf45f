// Players' declared controls at work on their Objects; what the tables mean is in shared/replica/Steering.h.
#pragma once

#include "engine/world/Player.h"
#include "shared/values/Keyboard.h"

namespace df {

class World;

/// The tick's part for all players with controls, between the step event and the first input.
void beginControlTick(World& world);
/// The part of one key, just before its event. Return whether the player's table handled it.
bool handleKey(World& world, Player& player, Keyboard::Key key, EventKeyboardAction action);

}  // namespace df
