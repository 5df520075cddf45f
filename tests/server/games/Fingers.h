// The keys that a bot holds down, sent to the world as a client would send them.
#pragma once

#include <cstdint>
#include <set>

#include "World.h"
#include "engine/world/InputQueue.h"

namespace naiad {

class Fingers {
 public:
  Fingers(df::World& world, std::uint32_t player) : m_world(world), m_player(player) {}

  /// Holds these keys down and releases all others.
  void hold(const std::set<df::Keyboard::Key>& keys) {
    for (const df::Keyboard::Key key : m_down) {
      if (!keys.contains(key)) m_world.input().key(m_player, key, df::KEY_RELEASED);
    }
    for (const df::Keyboard::Key key : keys)
      m_world.input().key(m_player, key, m_down.contains(key) ? df::KEY_DOWN : df::KEY_PRESSED);
    m_down = keys;
  }

 private:
  df::World& m_world;
  std::uint32_t m_player;
  std::set<df::Keyboard::Key> m_down;
};

}  // namespace naiad
