// A world with every visible change: objects fly, bounce, turn, are blocked, change their look, are created
// and deleted, and each player steers a ship.
#pragma once

#include "engine/world/World.h"

namespace naiad::test {

/// Fills the world with `count` creatures and an object that gives each player a ship.
void populateBusyWorld(df::World& world, int count);
/// Returns a function that calls populateBusyWorld(), for a TestServer.
inline auto busyWorld(int count) {
  return [count](df::World& world) { populateBusyWorld(world, count); };
}

}  // namespace naiad::test
