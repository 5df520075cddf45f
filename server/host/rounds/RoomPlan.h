// What a room is that has a name (--room), whether there is a world in it or not.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "host/world/WorldMessages.h"

namespace naiad {

class Round;

/// Begins a round in a world that was not there before. `home` runs the handlers of the host's thread, and
/// outlives it. Throws std::system_error if there can be none.
using NewWorld = std::function<std::unique_ptr<Round>(asio::io_context& home)>;

struct RoomPlan {
  std::string name;         ///< isRoomName()
  std::string game;         ///< the name of its module
  int max_players = 0;      ///< at a time
  bool first_only = false;  ///< of several players, only the first one's input is heard
  WorldReady ready;         ///< what the game sets up for those who join
  NewWorld new_world;
  /// Its first world goes on with the round of a server that was killed: it does not wait for players.
  bool goes_on = false;
  std::uint32_t highest_player = 0;  ///< id that a player of that round ever had
};

/// When a room sleeps, without a world, or stands still: its world is there and does not tick.
struct RoomSleep {
  using Time = std::chrono::steady_clock::time_point;
  bool asleep = false;
  bool still = false;
  std::optional<Time> empty_since;  ///< nothing: there are players
  Time closed_until{};              ///< its game failed again and again: it is not woken before
};

}  // namespace naiad
