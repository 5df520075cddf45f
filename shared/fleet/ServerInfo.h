// A server's description of itself for the local network, the bus and server lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace naiad {

class Json;

struct ServerInfo {
  static constexpr std::size_t kMaxName = 64;  ///< maximum characters of the name, and of the game

  std::string name;
  std::string game;            ///< the first room's game if there are several rooms
  std::uint32_t protocol = 0;  ///< the server's kProtocolVersion
  std::uint32_t players = 0;
  std::uint32_t max_players = 0;
  bool requires_password = false;

  friend bool operator==(const ServerInfo&, const ServerInfo&) = default;
};

/// Returns an object with name, game, players, max_players, password and protocol, in this order, as dfserver
/// --status-file, dfdir --list and dfclient --list --json write it. Texts are sanitized and truncated.
Json jsonOf(const ServerInfo& facts);

}  // namespace naiad
