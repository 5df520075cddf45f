// Decides whether a player may enter a named room, and wakes the room if it sleeps.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "host/rooms/Rooms.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixAllowance.h"

namespace naiad {

/// Not thread-safe.
class RoomDoor {
 public:
  using Time = std::chrono::steady_clock::time_point;

  enum class Why { kUnknown, kGame, kFull, kForNow };
  struct Refusal {
    Why why = Why::kUnknown;
    std::string sentence;  ///< message for the player
    std::string log;       ///< additional text for the server's log; may be empty
  };

  RoomDoor(Rooms& rooms, int max_per_address)
      : m_rooms(rooms), m_wakes(PrefixRates::wakes()), m_moves(PrefixRates::moves(max_per_address)) {}

  /// Finds a room by name; otherwise by game, preferring rooms with a free place and awake ones; otherwise
  /// the first. Null if none matches; `refusal` then says why.
  Room* findRoom(const std::string& name, const std::string& game, Refusal& refusal) const;
  /// Wakes the room if it sleeps. Returns why a player from `prefix` may not enter it; nullopt if they may.
  std::optional<Refusal> open(Room& room, const AddressPrefix& prefix, Time now);
  /// Counts a room change by a player from `prefix`. False if it is over the limit.
  bool takeMove(const AddressPrefix& prefix, Time now) { return m_moves.take(prefix, now); }

 private:
  Rooms& m_rooms;
  PrefixAllowance m_wakes;  ///< rate limit, because each wake starts a process
  PrefixAllowance m_moves;  ///< rate limit, because each move sends a world from the beginning
};

}  // namespace naiad
