// The rooms of the server, for games that lead players from one to another: a lobby, the end of a level.
//
//   df::GameRooms rooms;
//   for (const df::GameRoom& room : rooms.getRooms()) show(room.name, room.players);
//   if (rooms.send(p_player->getId(), "arcade") != 0) ...  // no such room
//
// What the server says of its rooms is an input of the world, as a key press is, and comes again when it has
// changed; where a player is sent is part of its output. The player leaves this world a tick or two later, by
// an EventLeave, and joins the other as a new one. The server may refuse: the room is full, or the player's
// client is too old to be led. It says so to the player, who stays.
//
// Without rooms (dfserver --room), and in tests, there are none until a test says so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "detail/GameRoom.h"

namespace df {

/// A name for what the current world knows of rooms. On the thread that runs the tick.
class GameRooms : public GameRoomLimits {
 public:
  /// In the order of the server's options: players begin in the first. Empty: the server has none.
  const std::vector<GameRoom>& getRooms() const;
  /// Ask the server to lead the player there. Return 0; or −1, and nothing happens: for a room that is not
  /// there, the one that this world is in, a player that is not in this world, more than kMaxSentInTick.
  int send(std::uint32_t player, const std::string& room) const;
};

}  // namespace df
