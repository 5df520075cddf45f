#include <gtest/gtest.h>

#include "GameMains.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

GameRoom room(const std::string& name, int players = 0) {
  return {.name = name, .game = "game of " + name, .players = players, .max_players = 8};
}

void keep(World& world, const GameRoom& room) {
  world.input().push({.kind = InputQueue::kRoom, .player = 0, .room = room});
}

/// Returns the room to which the game sent the player in the last tick, or "".
std::string sentTo(World& world, std::uint32_t player) {
  for (const RoomTransfer& sent : world.extras().rooms.sent()) {
    if (sent.player == player) return sent.room;
  }
  return {};
}

/// Walks to the door with this number. Returns the room to which the game sends the player on the way.
std::string walkTo(World& world, std::uint32_t player, int door) {
  const Vector goal = world.objects().objectsOfType("Door")[door]->getPosition();
  for (int i = 0; i < 200; ++i) {
    const Vector at = world.views().player(player)->getObject()->getPosition();
    const bool is_above = at.x() == goal.x();
    tap(world, player,
        is_above            ? Keyboard::DOWNARROW
        : at.x() < goal.x() ? Keyboard::RIGHTARROW
                            : Keyboard::LEFTARROW);
    world.tick();
    if (const std::string room = sentTo(world, player); !room.empty()) return room;
    tick(world, 2);
  }
  return {};
}

TEST(Lobby, EachOtherRoomHasADoorThatLeadsThere) {
  hostGame(lobby_main, 1, [](World& world) {
    GameRoom own = room("lobby");
    own.is_this_one = true;
    keep(world, own);
    keep(world, room("arcade", 3));
    keep(world, room("quiet"));
    const std::uint32_t ann = joinAnn(world, 2);
    EXPECT_EQ(world.objects().objectsOfType("Door").getCount(), 2);
    EXPECT_TRUE(shows(world, ann, "arcade"));
    EXPECT_TRUE(shows(world, ann, "game of arcade 3/8"));
    EXPECT_FALSE(shows(world, ann, "game of lobby"));
    EXPECT_EQ(walkTo(world, ann, 1), "quiet");
    tick(world, 2);
    EXPECT_EQ(sentTo(world, ann), "") << "once, while the server makes up its mind";
  });
}

TEST(Lobby, DoorShowsItsRoomsNewPlayerCount) {
  hostGame(lobby_main, 1, [](World& world) {
    keep(world, room("arcade", 3));
    const std::uint32_t ann = joinAnn(world, 2);
    keep(world, room("arcade", 8));
    world.tick();
    EXPECT_EQ(world.objects().objectsOfType("Door").getCount(), 1);
    EXPECT_TRUE(shows(world, ann, "8/8"));
    EXPECT_TRUE(shows(world, ann, "[XX]"));
  });
}

TEST(Lobby, ShowsThatThereAreNoOtherRooms) {
  hostGame(lobby_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 2);
    EXPECT_TRUE(shows(world, ann, "This server has no other rooms."));
  });
}

TEST(Lobby, FitsTheMaximumOfSixtyFourDoors) {
  hostGame(lobby_main, 1, [](World& world) {
    for (int i = 0; i < 64; ++i) keep(world, room("room-" + std::to_string(i)));
    const std::uint32_t ann = joinAnn(world, 2);
    EXPECT_EQ(world.objects().objectsOfType("Door").getCount(), 64);
    EXPECT_EQ(walkTo(world, ann, 0), "room-0");
  });
}

}  // namespace
}  // namespace naiad
