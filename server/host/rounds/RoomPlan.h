// What a room is that has a name (--room), whether there is a world in it or not.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "host/world/WorldMessages.h"

namespace naiad {

class Round;
class ScoreKeeper;

struct RoomPlan {
  std::string name;         ///< isRoomName()
  std::string game;         ///< the name of its module
  int max_players = 0;      ///< at a time
  bool first_only = false;  ///< of several players, only the first one's input is heard
  WorldReady ready;         ///< what the game sets up for those who join
  /// Makes its world; throws std::system_error if it cannot.
  std::function<std::unique_ptr<Round>()> new_world;
  ScoreKeeper* p_scores = nullptr;  ///< of the game; null: nothing is kept
  /// Its first world goes on with the round of a server that was killed: it does not wait for players.
  bool goes_on = false;
  std::uint32_t highest_player = 0;  ///< id that a player of that round ever had
};

/// When a room sleeps: it has no world then.
struct RoomSleep {
  using Time = std::chrono::steady_clock::time_point;
  bool asleep = false;
  std::optional<Time> empty_since;  ///< nothing: there are players
  Time closed_until{};              ///< its game failed again and again: it is not woken before
};

}  // namespace naiad
