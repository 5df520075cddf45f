// The game of the soak test. It has every visible change and reports every input that it receives.
//
// Creatures of many looks fly, bounce, turn, are blocked, blink, appear and vanish on a map three screens
// wide. Every player has a ship that the view follows; every second one steers it by declared controls.
#pragma once

#include <cstdint>
#include <functional>

#include "engine/events/EventKeyboard.h"
#include "engine/world/World.h"

namespace naiad::soak {

/// A player's key or mouse event that the game received.
struct Heard {
  std::uint32_t player = 0;
  bool is_mouse = false;
  int what = 0;    ///< the key or mouse button
  int action = 0;  ///< the keyboard or mouse action
};
using OnHeard = std::function<void(const Heard&)>;

/// Fills the world, which must be the thread's current one.
void populateSoak(df::World& world, int creatures, std::uint64_t seed, OnHeard on_heard);

}  // namespace naiad::soak
