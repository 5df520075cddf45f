// Decides whether a player may enter a named room, and wakes the room if it sleeps.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "host/rooms/RoomManager.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixRateLimiter.h"

namespace naiad {

/// Not thread-safe.
class RoomAdmission {
 public:
  using Time = std::chrono::steady_clock::time_point;

  enum class Reason { kUnknown, kGame, kFull, kTemporary };
  struct Refusal {
    Reason reason = Reason::kUnknown;
    std::string sentence;  ///< message for the player
    std::string log;       ///< more details for the server's log; may be empty
  };

  RoomAdmission(RoomManager& rooms, SessionTable& sessions, int max_per_address)
      : m_rooms(rooms),
        m_sessions(sessions),
        m_wakes(RateLimits::wakes()),
        m_moves(RateLimits::moves(max_per_address)) {}

  /// Finds the room `name`, which must play `game` if both are given; without a name, a room that plays
  /// `game`, preferably one with a free place that is awake; without both, the first room. If there is none,
  /// returns null, and `refusal` says why.
  Room* findRoom(const std::string& name, const std::string& game, Refusal& refusal) const;
  /// Opens the room to a player from `prefix`; makes a place if it is full (SessionTable::makePlace), and
  /// wakes it if it sleeps. Returns nullopt on success, otherwise the reason why the player may not enter.
  std::optional<Refusal> open(Room& room, const AddressPrefix& prefix, Time now);
  /// Counts a room change by a player from `prefix`. False if it is over the limit.
  bool tryMove(const AddressPrefix& prefix, Time now) { return m_moves.tryConsume(prefix, now); }

 private:
  RoomManager& m_rooms;
  SessionTable& m_sessions;
  PrefixRateLimiter m_wakes;  ///< rate limit, because each wake starts a process
  PrefixRateLimiter m_moves;  ///< rate limit, because each move sends a world from the beginning
};

}  // namespace naiad
