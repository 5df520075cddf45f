// The game of the soak: everything that can be seen happens in it, and it hears every key.
//
// Creatures of many looks fly, bounce, turn, are blocked, blink, die and are born on a map three screens
// wide. Every player has a ship that the view follows; every second one steers it by declared controls.
#pragma once

#include <cstdint>
#include <functional>

#include "engine/events/EventKeyboard.h"
#include "engine/world/World.h"

namespace naiad::soak {

/// What the game was told a player did, in the order in which it was told.
struct Heard {
  std::uint32_t player = 0;
  bool is_mouse = false;
  int what = 0;    ///< the key, or the mouse button
  int action = 0;  ///< of the keyboard or the mouse
};
using OnHeard = std::function<void(const Heard&)>;

/// Fill the world, which must be the thread's current one.
void populateSoak(df::World& world, int creatures, std::uint64_t seed, OnHeard on_heard);

}  // namespace naiad::soak
