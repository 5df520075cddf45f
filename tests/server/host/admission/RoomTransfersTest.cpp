// Moves of players between rooms, allowed and refused, with worlds that the test scripts.
#include <gtest/gtest.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/admission/RoomTransfers.h"
#include "tests/server/host/rooms/HostRooms.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::helloOf;

class RoomTransfersTest : public testing::Test, protected test::HostRooms {
 protected:
  Admission& openAll() {
    options.max_players = 8;
    rooms.setNamed({plan("lobby", 8), plan("arcade", 1), plan("quiet", 8)});
    rooms.setOnTransfer(
        [this](Session& session, const std::string& room) { moves.askByGame(session, room); });
    rooms.setOnRoomClosed(
        [this](const Room& room, const std::string& message) { moves.evacuate(room, message); });
    return admission();
  }
  RoomConfig plan(const std::string& name, int places) {
    return {.name = name,
            .game = "game of " + name,
            .max_players = places,
            .ready = {},
            .new_world = [this, name](asio::io_context&) {
              auto port = std::make_unique<test::FakeWorld>();
              ports[name] = port.get();
              ++begun[name];
              return std::make_unique<Round>(std::move(port));
            }};
  }
  Session::Events events() override {
    Session::Events all = HostRooms::events();
    all.on_list_rooms = [this](Session& session) { moves.sendList(session); };
    all.on_enter_room = [this](Session& session, const std::string& room) { moves.ask(session, room); };
    return all;
  }
  static wire::Hello helloTo(const std::string& name, const std::string& room, bool knows_rooms = true) {
    wire::Hello hello = helloOf(name);
    hello.set_room(room);
    hello.set_rooms(knows_rooms);
    return hello;
  }
  Client& join(const std::string& name, const std::string& room, bool knows_rooms = true) {
    Client& client = greet(helloTo(name, room, knows_rooms));
    EXPECT_TRUE(client.isWelcome());
    return client;
  }
  void tick() {
    now += 33ms;
    ++counters.ticks;
    rooms.checkWorlds();
    moves.update();
    rooms.beginTicks();
  }
  /// Returns the client's room, according to the messages it got.
  static std::string roomOf(const Client& client) {
    std::string room = client.welcome().room();
    for (const wire::ServerMessage& message : client.sent) {
      if (message.has_entered()) room = message.entered().room();
    }
    return room;
  }
  static std::string lastLine(const Client& client) {
    std::string line;
    for (const wire::ServerMessage& message : client.sent) {
      if (message.has_chat()) line = message.chat().text();
    }
    return line;
  }
  Session& sessionOf(const Client& client) {
    Session* p_found = nullptr;
    sessions.forEach([&](Session& session) {
      if (session.name() == client.welcome().name()) p_found = &session;
    });
    return *p_found;
  }

  std::size_t count(const std::string& room, df::InputQueue::Kind kind, std::uint32_t player) {
    return static_cast<std::size_t>(std::ranges::count_if(ports[room]->inputs(), [&](const auto& input) {
      return input.kind == kind && input.player == player;
    }));
  }

  std::map<std::string, test::FakeWorld*> ports;
  std::map<std::string, int> begun;
  RoomTransfers moves{context, sessions, rooms, openAll()};
};

TEST_F(RoomTransfersTest, HelloJoinsTheRoomOrGameItNames) {
  EXPECT_EQ(join("ann", "").welcome().room(), "lobby");
  EXPECT_EQ(join("bob", "quiet").welcome().game(), "game of quiet");
  wire::Hello by_game = helloTo("cid", "");
  by_game.set_game("game of arcade");
  EXPECT_EQ(greet(by_game).welcome().room(), "arcade");
  by_game.set_game("chess");
  EXPECT_EQ(greet(by_game).refusal(), wire::Refused::GAME);
  Client& lost = greet(helloTo("dan", "lobbi"));
  ASSERT_TRUE(lost.isRefused());
  EXPECT_EQ(lost.sent.front().refused().message(), "There is no room \"lobbi\"; did you mean \"lobby\"?");
  EXPECT_EQ(counters.refused_room, 1u);
  EXPECT_EQ(greet(helloTo("eve", "arcade")).refusal(), wire::Refused::FULL);
}

TEST_F(RoomTransfersTest, RoomsBeginWithTheirFirstPlayer) {
  EXPECT_EQ(begun["lobby"], 1) << "where players begin is always there at the start";
  EXPECT_EQ(begun["quiet"], 0);
  join("ann", "quiet");
  join("bob", "quiet");
  EXPECT_EQ(begun["quiet"], 1);
}

TEST_F(RoomTransfersTest, MoveSwitchesWorldsAndChangesThePlayerId) {
  Client& ann = join("ann", "lobby");
  tick();
  const std::uint32_t before = ann.welcome().player();
  ann.enter("quiet");
  EXPECT_EQ(roomOf(ann), "lobby") << "between two ticks";
  tick();
  EXPECT_EQ(roomOf(ann), "quiet");
  const std::uint32_t after = sessionOf(ann).player();
  EXPECT_GT(after, before);
  EXPECT_EQ(count("lobby", df::InputQueue::kLeave, before), 1u);
  EXPECT_EQ(count("quiet", df::InputQueue::kJoin, after), 1u);
  EXPECT_EQ(sessionOf(ann).welcomed().room(), "quiet") << "as a welcome back says it";
  EXPECT_EQ(counters.room_transfers, 1u);
  ann.enter("quiet");
  tick();
  EXPECT_EQ(counters.room_transfers, 1u) << "they are there";
}

TEST_F(RoomTransfersTest, RefusedMoveKeepsTheRoomAndTellsTheReason) {
  Client& ann = join("ann", "lobby");
  join("bob", "arcade");
  ann.enter("arcade");
  tick();
  EXPECT_EQ(roomOf(ann), "lobby");
  EXPECT_EQ(lastLine(ann), "The room \"arcade\" is full (1 players). Try again later.");
  ann.enter("quite");
  tick();
  EXPECT_EQ(lastLine(ann), "There is no room \"quite\"; did you mean \"quiet\"?");
  ann.enter("");
  tick();
  EXPECT_EQ(roomOf(ann), "lobby");
  ann.enter("\033[2J" + std::string(500, 'x'));
  tick();
  EXPECT_EQ(lastLine(ann).find('\033'), std::string::npos);
  EXPECT_EQ(counters.room_transfers, 0u);
  EXPECT_EQ(counters.room_moves_refused, 4u);
}

TEST_F(RoomTransfersTest, RequestsBeyondTwoASecondAreDropped) {
  Client& ann = join("ann", "lobby");
  wire::ClientMessage list;
  list.mutable_list_rooms();
  for (int i = 0; i < 100; ++i) ann.receive(list);
  const auto lists = [&] {
    return std::ranges::count_if(ann.sent, [](const auto& message) { return message.has_rooms(); });
  };
  EXPECT_EQ(lists(), 4);
  EXPECT_EQ(counters.room_requests_dropped, 96u);
  now += 1s;
  for (int i = 0; i < 100; ++i) ann.receive(list);
  EXPECT_EQ(lists(), 6);
}

TEST_F(RoomTransfersTest, TheListHasAllRooms) {
  Client& ann = join("ann", "quiet");
  wire::ClientMessage list;
  list.mutable_list_rooms();
  ann.receive(list);
  ASSERT_TRUE(ann.sent.back().has_rooms());
  const wire::RoomList& sent = ann.sent.back().rooms();
  ASSERT_EQ(sent.rooms_size(), 3);
  EXPECT_EQ(sent.rooms(0).name(), "lobby");
  EXPECT_FALSE(sent.rooms(0).asleep());
  EXPECT_TRUE(sent.rooms(1).asleep());
  EXPECT_EQ(sent.rooms(2).players(), 1u);
  EXPECT_EQ(sent.rooms(2).max_players(), 8u);
}

// An old client would take a room message for that of a broken server.
TEST_F(RoomTransfersTest, OldClientStaysInItsRoomWithoutRoomMessages) {
  Client& old = join("old", "", false);
  old.enter("quiet");
  moves.askByGame(sessionOf(old), "quiet");
  tick();
  EXPECT_EQ(roomOf(old), "lobby");
  EXPECT_NE(lastLine(old).find("too old"), std::string::npos);
  for (const wire::ServerMessage& message : old.sent)
    EXPECT_FALSE(message.has_entered() || message.has_rooms());
}

TEST_F(RoomTransfersTest, GameMovesOnlyItsOwnPlayers) {
  Client& ann = join("ann", "lobby");
  Client& bob = join("bob", "quiet");
  ports["lobby"]->next.sent = {
      {sessionOf(bob).player(), "arcade"}, {4711, "arcade"}, {sessionOf(ann).player(), "quiet"}};
  tick();
  tick();
  EXPECT_EQ(roomOf(ann), "quiet");
  EXPECT_EQ(roomOf(bob), "quiet");
}

TEST_F(RoomTransfersTest, RepeatedGameMovesDoNotFloodThePlayer) {
  Client& ann = join("ann", "lobby");
  for (int i = 0; i < 100; ++i) {
    ports["lobby"]->next.sent.assign(64, {sessionOf(ann).player(), "nowhere"});
    tick();
  }
  const auto lines = std::ranges::count_if(ann.sent, [](const auto& message) { return message.has_chat(); });
  EXPECT_LE(lines, 12) << "in 3.3 s";
  EXPECT_GE(lines, 4);
}

TEST_F(RoomTransfersTest, GamesReceiveTheRoomsAndTheirChanges) {
  const auto known = [&](const std::string& where, const std::string& name) {
    df::GameRoom last;
    for (const auto& input : ports[where]->inputs()) {
      if (input.kind == df::InputQueue::kRoom && input.room.name == name) last = input.room;
    }
    return last;
  };
  tick();
  EXPECT_TRUE(known("lobby", "lobby").is_this_one);
  EXPECT_TRUE(known("lobby", "quiet").is_asleep);
  EXPECT_EQ(known("lobby", "arcade").max_players, 1);
  join("ann", "quiet");
  for (int i = 0; i < 16; ++i) tick();
  EXPECT_TRUE(known("quiet", "quiet").is_this_one);
  EXPECT_EQ(known("lobby", "quiet").players, 1);
  EXPECT_FALSE(known("lobby", "quiet").is_asleep);
  const std::size_t inputs = ports["lobby"]->inputs().size();
  for (int i = 0; i < 60; ++i) tick();
  EXPECT_EQ(ports["lobby"]->inputs().size(), inputs) << "nothing has changed";
}

TEST_F(RoomTransfersTest, AddressMayWakeFourRoomsAtOnceMoreLater) {
  std::vector<RoomConfig> plans;
  for (int i = 0; i < 20; ++i) plans.push_back(plan("room-" + std::to_string(i), 8));
  RoomManager many{context, sessions, [] {}};
  many.setNamed(plans);
  many.open(world);
  RoomAdmission door(many, sessions, 64);
  const auto prefix = AddressPrefix::ofEndpoint("192.0.2.1:1").value_or(AddressPrefix());
  int woken = 0;
  for (int i = 1; i < 20; ++i)
    woken += door.open(*many.findRoom("room-" + std::to_string(i)), prefix, now) ? 0 : 1;
  EXPECT_EQ(woken, 4);
  EXPECT_FALSE(door.open(many.firstRoom(), prefix, now)) << "what is awake is open to all";
  EXPECT_FALSE(door.open(*many.findRoom("room-19"), prefix, now + 2s));
}

TEST_F(RoomTransfersTest, IdleCrowdOfARoomMakesPlaceThere) {
  options.max_players = 64;
  for (int i = 0; i < 8; ++i) join("idler", "quiet");
  Client& mover = greet(helloTo("mover", "lobby"), "203.0.113.1:1");
  now += 59s;
  EXPECT_EQ(greet(helloTo("ann", "quiet"), "203.0.113.2:1").refusal(), wire::Refused::FULL);
  mover.enter("quiet");
  tick();
  EXPECT_EQ(roomOf(mover), "lobby");
  now += 1s;
  EXPECT_TRUE(greet(helloTo("ann", "quiet"), "203.0.113.2:1").isWelcome());
  mover.enter("quiet");
  tick();
  EXPECT_EQ(roomOf(mover), "quiet");
  EXPECT_EQ(rooms.findRoom("quiet")->countPlaying(), 8u);
  EXPECT_EQ(counters.idle_kicks, 2u);
  EXPECT_EQ(sessions.playingCount(), 8u) << "those who made place have left the server";
}

TEST_F(RoomTransfersTest, RepeatedlyFailingRoomMovesPlayersToFirstRoom) {
  options.on_game_over = "restart";
  Client& ann = join("ann", "quiet");
  Client& old = join("old", "quiet", false);
  for (int i = 0; i < 5; ++i) {
    ports["quiet"]->ended = WorldEnd{WorldEnd::kCrashed, "crashed (SIGSEGV)"};
    tick();
  }
  tick();
  EXPECT_EQ(roomOf(ann), "lobby");
  EXPECT_EQ(begun["quiet"], 5);
  EXPECT_TRUE(old.sent.back().has_goodbye()) << "it cannot be led";
  EXPECT_EQ(greet(helloTo("bob", "quiet")).refusal(), wire::Refused::BUSY);
  EXPECT_FALSE(rooms.isOver()) << "the others go on";
}

}  // namespace
}  // namespace naiad
