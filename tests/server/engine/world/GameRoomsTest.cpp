#include "engine/world/GameRooms.h"
#include "engine/world/WorldExtras.h"
#include "tests/server/engine/Probe.h"

namespace df {
namespace {

class GameRoomsTest : public test::WorldTest {
 protected:
  void keep(const GameRoom& room) {
    world.input().push({.kind = InputQueue::kRoom, .player = 0, .room = room});
  }

  GameRooms rooms;
};

TEST_F(GameRoomsTest, RoomsKeepTheServersOrder) {
  EXPECT_TRUE(rooms.getRooms().empty());
  keep({.name = "one", .players = 1});
  keep({.name = "two"});
  keep({.name = "one", .players = 2});
  ASSERT_EQ(rooms.getRooms().size(), 2u);
  EXPECT_EQ(rooms.getRooms()[0].players, 2);
  EXPECT_EQ(rooms.getRooms()[1].name, "two");
}

TEST_F(GameRoomsTest, RoomCountAndNamesAreLimited) {
  for (std::size_t i = 0; i < 2 * GameRooms::kMaxRooms; ++i) keep({.name = "room-" + std::to_string(i)});
  keep({.name = std::string(GameRooms::kMaxName + 1, 'x')});
  keep({.name = ""});
  EXPECT_EQ(rooms.getRooms().size(), GameRooms::kMaxRooms);
}

TEST_F(GameRoomsTest, PlayersAreSentOnlyToOtherRooms) {
  keep({.name = "here", .is_this_one = true});
  keep({.name = "there"});
  const std::uint32_t ann = joined("ann");
  EXPECT_EQ(rooms.send(ann, "nowhere"), -1);
  EXPECT_EQ(rooms.send(ann, "here"), -1);
  EXPECT_EQ(rooms.send(ann + 1, "there"), -1) << "no such player";
  EXPECT_EQ(rooms.send(ann, "there"), 0);
  const auto sent = world.extras().rooms.popSent();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].player, ann);
  EXPECT_EQ(sent[0].room, "there");
  EXPECT_NE(world.views().player(ann), nullptr) << "until the server leads them away";
}

TEST_F(GameRoomsTest, TransfersAreLimitedPerTickThenForgotten) {
  keep({.name = "there"});
  const std::uint32_t ann = joined("ann");
  for (std::size_t i = 0; i < GameRooms::kMaxSentInTick; ++i) EXPECT_EQ(rooms.send(ann, "there"), 0);
  EXPECT_EQ(rooms.send(ann, "there"), -1);
  world.tick();
  EXPECT_TRUE(world.extras().rooms.popSent().empty());
}

}  // namespace
}  // namespace df
