// What a server says of itself wherever players look for one: in the local network, on the bus, in lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace naiad {

class Json;

struct ServerFacts {
  static constexpr std::size_t kMaxName = 64;  ///< characters of name and game

  std::string name;
  std::string game;            ///< of several that of the first room
  std::uint32_t protocol = 0;  ///< kProtocolVersion of the server
  std::uint32_t players = 0;
  std::uint32_t max_players = 0;
  bool asks_password = false;

  friend bool operator==(const ServerFacts&, const ServerFacts&) = default;
};

/// Returns an object with name, game, players, max_players, password and protocol, in this order, as
/// dfserver --status-file, dfdir --list and dfclient --list --json write it. Texts are made safe and cut.
Json jsonOf(const ServerFacts& facts);

}  // namespace naiad
