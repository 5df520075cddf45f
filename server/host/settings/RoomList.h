// The rooms that a server is to have (--room), as text and as values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/settings/HostOptions.h"

namespace naiad {

/// A room: a game by a name, in a process of its own, with its own limits.
struct RoomOptions {
  std::string name;  ///< isRoomName()
  std::string game;  ///< as of HostOptions
  // These are the server's, where the room does not say.
  int max_players = 0;  ///< at a time; the server's own limit holds for all rooms together
  int world_memory = 0;
  std::int64_t seed = 0;
  std::string players;  ///< "together" or "first"
};

/// The rooms of HostOptions::rooms, which has been checked: none if there are none. Players begin in the
/// first.
std::vector<RoomOptions> roomsOf(const HostOptions& options);

/// What is wrong with the rooms, or with what else was asked for beside them; empty if nothing is. Looks for
/// their games.
std::string roomsComplaint(const HostOptions& options);

/// With rooms there is no other game, and a round of theirs is followed by the next one: the options say so
/// from now on.
void useRooms(HostOptions& options);

/// The options of a server that has this room alone: for its worlds.
HostOptions optionsOf(const HostOptions& options, const RoomOptions& room);

/// `There is no room "tronn"; did you mean "tron"?`, or all names if none is near. `typed` may be anything.
std::string unknownRoom(const std::string& typed, const std::vector<std::string>& names);

}  // namespace naiad
