// May a player enter a room that has a name? Wakes it if it sleeps.
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
    std::string sentence;  ///< for the player
    std::string log;       ///< what the server's log is to have beside it; empty: nothing
  };

  RoomDoor(Rooms& rooms, int max_per_address)
      : m_rooms(rooms), m_wakes(PrefixRates::wakes()), m_moves(PrefixRates::moves(max_per_address)) {}

  /// The room that is asked for: by name; else by game, one that has a place, a room that is awake before one
  /// that sleeps; else the first. Null: there is none, and `refusal` says why.
  Room* findRoom(const std::string& name, const std::string& game, Refusal& refusal) const;
  /// The room is awake now, or begins, and has a place; else why a player from there may not enter it.
  std::optional<Refusal> open(Room& room, const AddressPrefix& prefix, Time now);
  /// May one from there change rooms once more?
  bool takeMove(const AddressPrefix& prefix, Time now) { return m_moves.take(prefix, now); }

 private:
  Rooms& m_rooms;
  PrefixAllowance m_wakes;  ///< each starts a process
  PrefixAllowance m_moves;  ///< each sends a world from the beginning
};

}  // namespace naiad
