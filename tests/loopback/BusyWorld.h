// A world with every visible change: objects fly, bounce, turn, are blocked, change their look, are created
// and deleted, and each player steers a ship.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "engine/world/World.h"

namespace naiad::test {

/// A player's key or mouse event that the game received.
struct Heard {
  std::uint32_t player = 0;
  bool is_mouse = false;
  int what = 0;    ///< the key or mouse button
  int action = 0;  ///< the keyboard or mouse action
};

/// Counts the game's events of all players. May be read from any thread. Must outlive the server.
struct Census {
  std::atomic<int> joins = 0;
  std::atomic<int> leaves = 0;
  std::atomic<int> pressed = 0;
  std::atomic<int> released = 0;
  std::function<void(const Heard&)> on_heard = nullptr;  ///< called for each key and mouse event
};

/// The size of the world, in cells. In a rich one, frames also change by themselves, the view follows the
/// player's ship, and every second player steers it by declared controls.
struct BusyScene {
  int width = 80;
  int height = 24;
  bool is_rich = false;
  std::uint64_t seed = 7;
};

/// Fills the world, which must be the thread's current one, with `count` creatures and an object that gives
/// each player a ship.
void populateBusyWorld(df::World& world, int count, Census* p_census = nullptr, const BusyScene& scene = {});
/// Returns a function that calls populateBusyWorld(), for a TestServer.
inline auto busyWorld(int count, Census* p_census = nullptr) {
  return [=](df::World& world) { populateBusyWorld(world, count, p_census); };
}

}  // namespace naiad::test
