// A world in which everything happens that can be seen: objects fly, bounce, turn, are blocked, change their
// look, die and are born, and every player steers a ship.
#pragma once

#include "engine/world/World.h"

namespace naiad::test {

/// Fill the world with `count` creatures and the object that welcomes players.
void populateBusyWorld(df::World& world, int count);
/// The same for a TestServer.
inline auto busyWorld(int count) {
  return [count](df::World& world) { populateBusyWorld(world, count); };
}

}  // namespace naiad::test
