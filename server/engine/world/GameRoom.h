// A room of the server as a game sees it, and the limits of GameRooms.
#pragma once

#include <cstddef>
#include <string>

namespace df {

/// What a game knows of one room of its server.
struct GameRoom {
  std::string name = {};     ///< for GameRooms::send()
  std::string game = {};     ///< that is played there
  int players = 0;           ///< that are there
  int max_players = 0;       ///< that find place
  bool is_asleep = false;    ///< it has had no players for a while, and begins with the next one
  bool is_this_one = false;  ///< this world is in it
  friend bool operator==(const GameRoom&, const GameRoom&) = default;
};

struct GameRoomLimits {
  static constexpr std::size_t kMaxRooms = 64;
  static constexpr std::size_t kMaxName = 32;        ///< characters of a room's name
  static constexpr std::size_t kMaxGame = 40;        ///< characters of a game's name
  static constexpr std::size_t kMaxSentInTick = 64;  ///< players
  static constexpr int kMaxPlayers = 20'000;
};

}  // namespace df
