// The world of the network's measurements: `busy1000`, and two that should cost nothing.
//
// 1000 single characters on 320 by 96 cells. 80 % walk at up to ±0.5 cells per tick across and ±0.25 down, 10
// % stand, 10 % run at ±1 across; they bounce at the edges. In each tick 1 % turn, 2 % change their
// character, 0.2 % die while another is born elsewhere. All of it through df::Object, seeded.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/Capture.h"
#include "engine/world/World.h"

namespace bench {

inline constexpr int kBusyWidth = 320;
inline constexpr int kBusyHeight = 96;

class BusyScene {
 public:
  enum class Kind {
    kBusy,
    kStraight,  ///< nobody turns, changes or dies, and nobody comes to an edge for two minutes
    kStill,     ///< nobody does anything
  };

  /// Every player's view is `width` by `height` cells; several players see the world's parts in turn.
  BusyScene(Kind kind, int objects, int width, int height, int players, std::uint64_t seed);
  ~BusyScene();

  void tick();
  const df::World& world() const { return m_world; }
  /// What a player ought to see, by the engine's own draw().
  df::Canvas truth(std::uint32_t player) const { return m_world.picture().renderPlayer(player); }
  const std::vector<std::uint32_t>& players() const { return m_players; }

 private:
  df::World m_world;
  std::vector<std::uint32_t> m_players;
};

/// Make that world of the current one: its boundary, and `objects` that walk about.
void populateBusy(BusyScene::Kind kind, int objects);

}  // namespace bench
