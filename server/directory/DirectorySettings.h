// What a directory is given, beside its log.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "host/fleet/Bus.h"
#include "server/directory/Lobby.h"
#include "shared/fleet/Presence.h"

namespace naiad {

struct DirectorySettings {
  BusSettings bus;
  std::chrono::milliseconds interval = Presence::kInterval;  ///< in which its servers say that they are there
  std::string list;                                          ///< file for the list of servers; empty: none
  std::optional<LobbySettings> lobby;                        ///< nothing: none
  std::string identity;     ///< folder of the lobby's key; empty: the user's (ServerIdentity.h)
  std::string certificate;  ///< PEM file, in place of that folder; empty: none
  std::string key;          ///< the same
};

}  // namespace naiad
