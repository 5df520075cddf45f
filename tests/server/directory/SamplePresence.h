// A server's presence on the bus, as tests of the directory use it.
#pragma once

#include <string>

#include "server/directory/FleetRegistry.h"
#include "shared/fleet/BusPayloads.h"

namespace naiad::test {

inline Presence presenceOf(const std::string& id, std::uint32_t players = 0, std::uint32_t max_players = 16) {
  Presence presence;
  presence.id = id;
  presence.name = "Server " + id;
  presence.game = "tron";
  presence.host = id + ".example";
  presence.port = 9876;
  presence.key = std::string(64, 'a');
  presence.protocol = 4;
  presence.players = players;
  presence.max_players = max_players;
  return presence;
}

inline void handleHeartbeat(FleetRegistry& list, const Presence& presence, FleetRegistry::Time now = {}) {
  list.handleHeartbeat(presenceSubject(presence.id), presence.payload(), now);
}

}  // namespace naiad::test
