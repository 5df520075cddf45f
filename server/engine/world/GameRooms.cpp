#include "engine/world/GameRooms.h"

#include <algorithm>
#include <utility>

#include "engine/world/RoomTable.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

GameRoom* RoomTable::find(const std::string& name) {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(),
                                  [&name](const GameRoom& room) { return room.name == name; });
  return found != m_rooms.end() ? &*found : nullptr;
}

void RoomTable::keep(GameRoom room) {
  if (room.name.empty() || room.name.size() > GameRooms::kMaxName) return;
  if (GameRoom* p_room = find(room.name)) {
    *p_room = std::move(room);
  } else if (m_rooms.size() < GameRooms::kMaxRooms) {
    m_rooms.push_back(std::move(room));
  }
}

bool RoomTable::send(std::uint32_t player, const std::string& room) {
  const GameRoom* p_room = find(room);
  if (p_room == nullptr || p_room->is_this_one || m_sent.size() >= GameRooms::kMaxSentInTick) return false;
  m_sent.push_back({player, room});
  return true;
}

const std::vector<GameRoom>& GameRooms::getRooms() const {
  static const std::vector<GameRoom> none;
  const WorldExtras* p_extras = World::current().findExtras();
  return p_extras != nullptr ? p_extras->rooms.rooms() : none;
}

int GameRooms::send(std::uint32_t player, const std::string& room) const {
  World& world = World::current();
  if (world.getPlayer(player) != nullptr && world.extras().rooms.send(player, room)) return 0;
  world.refuse("GameRooms", "send");
  return -1;
}

}  // namespace df
