// The rooms of the server, for games that move players from one to another: a lobby, the end of a level.
//
//   df::GameRooms rooms;
//   for (const df::GameRoom& room : rooms.getRooms()) show(room.name, room.players);
//   if (rooms.send(p_player->getId(), "arcade") != 0) ...  // no such room
//
// The server's report on a room is an input of the world, like a key press; the server sends another when the
// room has changed. The order to move a player is part of the world's output. The player leaves this world a
// tick or two later, with an EventLeave, and joins the other room as a new player. The server may refuse, for
// example because the room is full; then it tells the player, and they stay. It drops too frequent orders.
//
// Without dfserver's --room, the list of rooms is empty. In tests it is empty until the test adds rooms.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "detail/GameRoom.h"

namespace df {

/// Gives access to the rooms that the current world knows. Call it on the thread that runs the tick.
class GameRooms : public GameRoomLimits {
 public:
  /// Returns the rooms in the order of the server's options; new players begin in the first. May be empty. A
  /// round that continues after a restart of the server keeps its list: new rooms are at its end, and those
  /// that the server no longer has are closed (`max_players` is 0).
  const std::vector<GameRoom>& getRooms() const;
  /// Asks the server to move the player to the room. Returns 0, or −1 without effect if there is no such
  /// room, it is this world's own, the player is not in this world, or kMaxSentInTick were sent in this tick.
  int send(std::uint32_t player, const std::string& room) const;
};

}  // namespace df
