// What a world knows of the server's rooms, and which players its game sends there (GameRooms.h).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/GameRoom.h"

namespace df {

/// A player that the game sends to another room.
struct SentPlayer {
  std::uint32_t player = 0;
  std::string room;
};

class RoomTable {
 public:
  /// The room is so from now on; one that was not there before is behind the others. Nothing happens if it is
  /// no room, or one too many.
  void keep(GameRoom room);
  const std::vector<GameRoom>& rooms() const { return m_rooms; }
  /// False: there is no such room to send to, or too many were sent in this tick.
  bool send(std::uint32_t player, const std::string& room);
  /// Those who were sent in the last tick. What is not taken before the next one begins is forgotten.
  std::vector<SentPlayer> takeSent() { return std::exchange(m_sent, {}); }
  const std::vector<SentPlayer>& sent() const { return m_sent; }
  void beginTick() { m_sent.clear(); }

 private:
  GameRoom* find(const std::string& name);

  std::vector<GameRoom> m_rooms;
  std::vector<SentPlayer> m_sent;
};

}  // namespace df
