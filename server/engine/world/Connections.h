// The players of a world as the connections of the published engine's NetworkManager: for games that were
// written as two programs, of which the server's half is played here (published/NetworkServer.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace df {

struct Connections {
  bool is_server = false;
  /// At most so many players are connected; the others watch.
  int limit = 16;
  /// Is the game's server a player itself (NetworkServer.h)?
  bool has_host = false;
  /// The player that sits at the server then; 0 for none.
  std::uint32_t host = 0;
  /// Players whose connection the game has closed.
  std::vector<std::uint32_t> closed;
  /// By socket, which is an index here: the player, or 0 for none.
  std::vector<std::uint32_t> players;

  /// The socket of a player; -1 for none.
  int socketOf(std::uint32_t player) const {
    const auto found = std::find(players.begin(), players.end(), player);
    return player == 0 || found == players.end() ? -1 : static_cast<int>(found - players.begin());
  }
  bool isConnected(int socket) const {
    return socket >= 0 && socket < static_cast<int>(players.size()) &&
           players[static_cast<std::size_t>(socket)] != 0;
  }
  int count() const {
    return static_cast<int>(players.size() -
                            static_cast<std::size_t>(std::count(players.begin(), players.end(), 0u)));
  }
};

}  // namespace df
