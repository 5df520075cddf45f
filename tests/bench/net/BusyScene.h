// The worlds of the network measurements: `busy1000`, and two in which nothing changes that must be sent.
//
// 1000 single characters on 320 by 96 cells. 80 % walk at up to ±0.5 cells per tick across and ±0.25 down, 10
// % stand, 10 % run at ±1 across; they bounce at the edges. In each tick 1 % turn, 2 % change their
// character, 0.2 % die while another is born elsewhere. All of this uses df::Object and is seeded.
#pragma once

#include <cstdint>

#include "engine/world/Capture.h"
#include "engine/world/World.h"

namespace bench {

inline constexpr int kBusyWidth = 320;
inline constexpr int kBusyHeight = 96;

class BusyScene {
 public:
  enum class Kind {
    kBusy,
    kStraight,  ///< no turns, changes or deaths, and no walker at an edge for two minutes
    kStill,     ///< no changes at all
  };

  /// Each player's view is `width` by `height` cells. The views are spread over the parts of the world in
  /// turn.
  BusyScene(Kind kind, int width, int height, int players);
  ~BusyScene();

  void tick();
  const df::World& world() const { return m_world; }
  /// Returns the player's picture by the engine's own draw().
  df::Canvas truth(std::uint32_t player) const { return m_world.picture().renderPlayer(player); }

 private:
  df::World m_world;
};

/// Fills the current world: its boundary, and 1000 walkers.
void populateBusy(BusyScene::Kind kind);

}  // namespace bench
