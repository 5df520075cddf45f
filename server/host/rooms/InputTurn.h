// Which player's input reaches the game, if only one player's does (HostOptions::players, "first").
#pragma once

#include <cstdint>
#include <utility>

#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

class InputTurn {
 public:
  explicit InputTurn(bool first_only) : m_first_only(first_only) {}

  bool isOneOnly() const { return m_first_only; }
  /// Whose turn it is; 0: no player's.
  std::uint32_t player() const { return m_player; }
  /// It is this player's turn. True: it was another player's before.
  bool passTo(std::uint32_t player) {
    if (player == m_player) return false;
    m_before = std::exchange(m_player, player);
    return player != 0 && m_before != 0;
  }
  /// Keys that the player before still holds may be released.
  bool isHeard(std::uint32_t player, const Input& input) const {
    if (!m_first_only || player == m_player) return true;
    return !input.is_mouse && input.action == df::KEY_RELEASED && player == m_before;
  }

 private:
  bool m_first_only;
  std::uint32_t m_player = 0;
  std::uint32_t m_before = 0;
};

}  // namespace naiad
