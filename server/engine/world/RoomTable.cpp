#include "engine/world/RoomTable.h"

#include <algorithm>
#include <utility>

namespace df {

GameRoom* RoomTable::find(const std::string& name) {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(),
                                  [&name](const GameRoom& room) { return room.name == name; });
  return found != m_rooms.end() ? &*found : nullptr;
}

void RoomTable::keep(GameRoom room) {
  if (room.name.empty() || room.name.size() > GameRoomLimits::kMaxName) return;
  if (GameRoom* p_room = find(room.name)) {
    *p_room = std::move(room);
  } else if (m_rooms.size() < GameRoomLimits::kMaxRooms) {
    m_rooms.push_back(std::move(room));
  }
}

bool RoomTable::send(std::uint32_t player, const std::string& room) {
  const GameRoom* p_room = find(room);
  if (p_room == nullptr || p_room->is_this_one || m_sent.size() >= GameRoomLimits::kMaxSentInTick)
    return false;
  m_sent.push_back({player, room});
  return true;
}

}  // namespace df
