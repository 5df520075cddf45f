// The server's rooms as a world knows them, and the players that its game sends to them (GameRooms.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/GameRoom.h"

namespace df {

/// A player that the game sends to another room.
struct RoomTransfer {
  std::uint32_t player = 0;
  std::string room;
};

class GameRoomTable {
 public:
  /// Adds a room at the end, or updates the one of this name. Ignores invalid rooms and excess ones.
  void update(GameRoom room) {
    if (room.name.empty() || room.name.size() > GameRoomLimits::kMaxName) return;
    if (GameRoom* p_room = find(room.name)) {
      *p_room = std::move(room);
    } else if (m_rooms.size() < GameRoomLimits::kMaxRooms) {
      m_rooms.push_back(std::move(room));
    }
  }
  const std::vector<GameRoom>& rooms() const { return m_rooms; }
  /// Sends a player to a room. False for an unknown room or this world's own, or after too many in this tick.
  bool send(std::uint32_t player, const std::string& room) {
    const GameRoom* p_room = find(room);
    const bool is_full = m_sent.size() >= GameRoomLimits::kMaxSentInTick;
    if (p_room == nullptr || p_room->is_this_one || is_full) return false;
    m_sent.push_back({player, room});
    return true;
  }
  /// Returns and removes the players sent in the last tick. The beginning of the next tick removes them, too.
  std::vector<RoomTransfer> popSent() { return std::exchange(m_sent, {}); }
  const std::vector<RoomTransfer>& sent() const { return m_sent; }
  void beginTick() { m_sent.clear(); }

 private:
  GameRoom* find(const std::string& name) {
    const auto is_named = [&name](const GameRoom& room) { return room.name == name; };
    const auto found = std::find_if(m_rooms.begin(), m_rooms.end(), is_named);
    return found != m_rooms.end() ? &*found : nullptr;
  }

  std::vector<GameRoom> m_rooms;
  std::vector<RoomTransfer> m_sent;
};

}  // namespace df
