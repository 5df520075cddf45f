// Parses and checks the named rooms of a server (--room).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/settings/HostOptions.h"

namespace naiad {

/// A named room: a game in a process of its own, with its own limits.
struct RoomOptions {
  std::string name;  ///< name for which isRoomName() is true
  std::string game;  ///< shipped game or path of a module, as in HostOptions::game
  // The defaults of the following are the server's options.
  int max_players = 0;  ///< limit of this room; the server's own limit applies to all rooms together
  int world_memory = 0;
  std::int64_t seed = 0;
  std::string players;  ///< "together" or "first"
};

/// Parses HostOptions::rooms, which must have been checked. Players start in the first room.
std::vector<RoomOptions> parseRooms(const HostOptions& options);

/// Returns a message about an invalid room or an option that contradicts --room; empty if all are valid.
/// Checks on disk that the games exist.
std::string validateRoomOptions(const HostOptions& options);

/// If there are rooms, sets `game` to the first room's game and `on_game_over` to "restart".
void useRooms(HostOptions& options);

/// Returns the options of a server that has only this room, to start its worlds with.
HostOptions optionsOf(const HostOptions& options, const RoomOptions& room);

/// Returns `There is no room "tronn"; did you mean "tron"?`, or a message with all names if none is similar.
/// `typed` may be any text.
std::string unknownRoomMessage(const std::string& typed, const std::vector<std::string>& names);

}  // namespace naiad
