#include "engine/world/GameRooms.h"

#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"

namespace df {

const std::vector<GameRoom>& GameRooms::getRooms() const {
  static const std::vector<GameRoom> none;
  const WorldExtras* p_extras = World::current().findExtras();
  return p_extras != nullptr ? p_extras->rooms.rooms() : none;
}

int GameRooms::send(std::uint32_t player, const std::string& room) const {
  World& world = World::current();
  if (world.views().player(player) != nullptr && world.extras().rooms.send(player, room)) return 0;
  return world.log().refuse("GameRooms", "send");
}

}  // namespace df
