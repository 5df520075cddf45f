// Settings and sleep state of a named room (--room), which may have no world.
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

/// Begins a round in a new world. `home` runs the handlers of the host's thread, and outlives the round.
/// Throws std::system_error on failure.
using NewWorld = std::function<std::unique_ptr<Round>(asio::io_context& home)>;

struct RoomConfig {
  std::string name;         ///< valid by isRoomName()
  std::string game;         ///< name of the game's module
  int max_players = 0;      ///< maximum number of players at a time
  bool first_only = false;  ///< only the first player's input is used
  WorldReady ready;         ///< settings of the game, for the players that will join
  NewWorld new_world;
  /// True if the first world resumes a killed server's round, so that the room starts without players.
  bool resumes_round = false;
};

/// State of a room that is asleep (without a world) or still (its world exists and does not tick).
struct RoomSleepState {
  using Time = std::chrono::steady_clock::time_point;
  bool asleep = false;
  bool still = false;
  std::optional<Time> empty_since;  ///< nullopt: the room has players
  Time closed_until{};              ///< the room is not woken before this time: its game could not continue
};

}  // namespace naiad
