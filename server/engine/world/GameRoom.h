// A room of the server as a game sees it, and the limits of GameRooms.
#pragma once

#include <cstddef>
#include <string>

namespace df {

/// A room of the server, as a game sees it.
struct GameRoom {
  std::string name = {};     ///< the name that GameRooms::send() takes
  std::string game = {};     ///< the game that is played there
  int players = 0;           ///< players in the room
  int max_players = 0;       ///< limit of `players`
  bool is_asleep = false;    ///< true: no world, for lack of players; the next join starts one
  bool is_this_one = false;  ///< true for the room of this world
  friend bool operator==(const GameRoom&, const GameRoom&) = default;
};

/// Limits of the rooms of a server.
struct GameRoomLimits {
  static constexpr std::size_t kMaxRooms = 64;
  static constexpr std::size_t kMaxName = 32;        ///< characters in a room's name
  static constexpr std::size_t kMaxGame = 40;        ///< characters in a game's name
  static constexpr std::size_t kMaxSentInTick = 64;  ///< players that can be sent to rooms in one tick
  static constexpr int kMaxPlayers = 20'000;
};

}  // namespace df
