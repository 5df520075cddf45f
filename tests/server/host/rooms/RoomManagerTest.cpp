// Which parts of a world's report reach the players of other worlds.
#include <gtest/gtest.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/managers/WorldManager.h"
#include "tests/server/host/rooms/HostRooms.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::helloOf;

df::PlayerFacts factsOf(std::uint32_t id, const std::string& name, int score) {
  df::PlayerFacts facts;
  facts.id = id;
  facts.name = name;
  facts.score = score;
  return facts;
}

/// Players in worlds of their own, unless the constructor gets another input mode.
class RoomManagerTest : public testing::Test, protected test::HostRooms {
 protected:
  explicit RoomManagerTest(const std::string& players = "private") {
    options.players = players;
    rooms.setWorlds([this](asio::io_context&) {
      auto port = std::make_unique<test::FakeWorld>();
      ports.push_back(port.get());
      return std::make_unique<Round>(std::move(port));
    });
    admission();
  }

  Client& join(const std::string& name) {
    Client& client = greet(helloOf(name));
    EXPECT_TRUE(client.isWelcome());
    return client;
  }
  /// Sends the list, as a host does at the end of a tick in which it is due.
  void sendList() {
    rooms.beginTicks();
    news.tick(
        0, rooms.players(), [](std::uint32_t) { return 0u; },
        [this](std::uint32_t player, const wire::ServerMessage& message) {
          EXPECT_LE(message.ByteSizeLong(), kMaxServerFrame);
          if (Session* p_session = rooms.findPlayer(player)) p_session->sendReliable(message);
        });
  }
  /// Returns the newest list that arrived, as "name=score" lines; empty if none did.
  static std::vector<std::string> listOf(const Client& client) {
    std::vector<std::string> lines;
    for (const wire::ServerMessage& message : client.sent) {
      if (!message.has_players()) continue;
      lines.clear();
      for (const wire::PlayerEntry& entry : message.players().players())
        lines.push_back(entry.name() + "=" + std::to_string(entry.score()));
    }
    return lines;
  }

  std::vector<test::FakeWorld*> ports;
};

class EmptyWorldTest : public RoomManagerTest {
 protected:
  EmptyWorldTest() : RoomManagerTest("together") {}

  /// True if the world ticks in a tick of the host at `now` + `after`.
  bool ticks(std::chrono::seconds after) {
    const std::size_t before = ports[0]->turns.size();
    rooms.checkWorlds(now + after);
    rooms.beginTicks();
    return ports[0]->turns.size() > before;
  }
};

TEST_F(EmptyWorldTest, PausesAfterAMinuteUntilAPlayerJoins) {
  options.grace = 0;
  EXPECT_TRUE(ticks(0s));
  EXPECT_TRUE(ticks(59s));
  EXPECT_FALSE(rooms.rest());
  EXPECT_FALSE(ticks(60s));
  EXPECT_TRUE(rooms.rest());
  Client& ann = join("ann");
  EXPECT_TRUE(ticks(3600s));
  EXPECT_FALSE(rooms.rest());
  EXPECT_TRUE(ticks(7200s)) << "ann is there";
  ann.drop();
  ASSERT_EQ(sessions.playingCount(), 0u);
  EXPECT_TRUE(ticks(7201s)) << "the minute begins when she has left";
  EXPECT_TRUE(ticks(7260s));
  EXPECT_FALSE(ticks(7261s));
}

TEST_F(EmptyWorldTest, DisconnectedPlayerKeepsTheWorldRunning) {
  options.grace = 1000;
  join("ann").drop();
  ASSERT_EQ(sessions.playingCount(), 1u);
  EXPECT_TRUE(ticks(0s));
  EXPECT_TRUE(ticks(900s));
}

TEST_F(EmptyWorldTest, KeepsRunningIfTheGameRequestsIt) {
  WM.setRunsEmpty();
  EXPECT_TRUE(ticks(0s));
  EXPECT_TRUE(ticks(3600s));
  WM.setRunsEmpty(false);
  EXPECT_FALSE(ticks(3601s));
}

TEST_F(EmptyWorldTest, KeepsRunningForRequestedTicksOrALastRound) {
  EXPECT_TRUE(ticks(0s));
  options.ticks = 10'000;
  EXPECT_TRUE(ticks(3600s));
  options.ticks = 0;
  EXPECT_FALSE(ticks(3601s));
  rooms.setLastRound(true);
  EXPECT_TRUE(ticks(3602s)) << "the server ends with the round";
}

class IdleCrowdTest : public RoomManagerTest, public testing::WithParamInterface<const char*> {
 protected:
  IdleCrowdTest() : RoomManagerTest(GetParam()) {}
};

TEST_P(IdleCrowdTest, OneAddressWithIdlePlayersCannotKeepItFull) {
  for (int i = 0; i < options.max_players; ++i)
    ASSERT_TRUE(greet(helloOf("idler"), "192.0.2.1:" + std::to_string(i + 1)).isWelcome()) << i;
  now += 59s;
  EXPECT_EQ(greet(helloOf("ann"), "203.0.113.1:1").refusal(), wire::Refused::FULL);
  now += 1s;
  EXPECT_TRUE(greet(helloOf("ann"), "203.0.113.1:1").isWelcome());
  EXPECT_EQ(greet(helloOf("bob"), "203.0.113.1:2").refusal(), wire::Refused::FULL)
      << "the address holds a place";
  EXPECT_EQ(greet(helloOf("idler"), "192.0.2.1:99").refusal(), wire::Refused::FULL);
  EXPECT_TRUE(greet(helloOf("cid"), "203.0.113.2:1").isWelcome());
  EXPECT_EQ(counters.idle_kicks, 2u);
}

INSTANTIATE_TEST_SUITE_P(Modes, IdleCrowdTest, testing::Values("together", "first", "private"));

/// A second player's part in the game: + an Object to follow or steer, - none.
struct Part {
  const char* mode;
  bool has_controls;
  const char* own;     ///< the player's, for consecutive periods of a minute
  const char* others;  ///< the first player's
  const char* keys;    ///< + if the player is active at the beginning of the minute
  int idle;            ///< minutes that count as idle at the end
};

class PartTest : public RoomManagerTest, public testing::WithParamInterface<Part> {
 protected:
  PartTest() : RoomManagerTest(GetParam().mode) {}

  static df::PlayerFacts facts(std::uint32_t id, bool has_object) {
    df::PlayerFacts player = factsOf(id, "", 0);
    if (has_object) player.followed = {id, 1};
    if (GetParam().has_controls) player.steering.p_table = std::make_shared<df::ControlTable>();
    player.steering.state.steering = GetParam().has_controls && has_object;
    return player;
  }
};

TEST_P(PartTest, TimeOfOnlyWatchingIsNotIdle) {
  join("other");
  join("player");
  SessionStatus& status = rooms.findPlayer(2)->status();
  for (std::size_t i = 0; GetParam().own[i] != 0; ++i) {
    ports[0]->picture.players = {facts(1, GetParam().others[i] == '+'), facts(2, GetParam().own[i] == '+')};
    rooms.beginTicks();
    if (GetParam().keys[i] == '+') status.onActivity(now);
    now += 1min;
    rooms.beginTicks();
  }
  EXPECT_EQ(status.idle(now), std::chrono::minutes(GetParam().idle));
}

INSTANTIATE_TEST_SUITE_P(
    Games, PartTest,
    testing::Values(Part{"together", false, "++", "++", "--", 2}, Part{"together", true, "++", "++", "--", 2},
                    Part{"together", false, "++", "++", "-+", 1},
                    Part{"together", false, "---", "+++", "---", 0},  // waits for a place in the game
                    Part{"together", false, "--", "--", "--", 2},  // a title screen, which may expect a key
                    Part{"together", false, "+---", "++++", "+---", 1},  // has played and lost
                    Part{"together", true, "+---", "++++", "+---", 1},
                    Part{"together", true, "+-+", "+++", "+--", 2},  // plays again: the minute continues
                    Part{"together", true, "+--", "+++", "---", 3},  // lost without a key
                    Part{"first", false, "+++", "+++", "---", 0}));  // it is another player's turn

constexpr std::uint32_t kTicksPerSecond = 2;

class AuditTurnsTest : public RoomManagerTest {
 protected:
  void tick(int count) {
    for (int i = 0; i < count; ++i, ++counters.ticks) rooms.beginTicks();
  }
  /// Returns the number of ticks in which the world's own player was rendered. Checks that no other player
  /// was.
  std::size_t wanted(std::size_t number, const Client& client) const {
    std::vector<std::uint32_t> all;
    for (const auto& [turn, record] : ports[number]->turns)
      all.push_back(turn.wants_truth ? turn.rendered_player : 0);
    const auto own = std::ranges::count(all, client.welcome().player());
    EXPECT_EQ(own + std::ranges::count(all, 0u), static_cast<std::ptrdiff_t>(all.size()));
    return static_cast<std::size_t>(own);
  }
};

TEST_F(AuditTurnsTest, NoPictureIsRequestedWithoutAnAudit) {
  const Client& ann = join("Ann");
  tick(40);
  EXPECT_EQ(wanted(0, ann), 0u);
}

TEST_F(AuditTurnsTest, OnePlayersPictureIsRequestedOneSecondInTen) {
  rooms.startAudit(kTicksPerSecond);
  const Client& ann = join("Ann");
  const Client& bob = join("Bob");
  tick(2 * AuditScheduler::kPeriod * kTicksPerSecond);
  EXPECT_EQ(wanted(0, ann), 2 * kTicksPerSecond);
  EXPECT_EQ(wanted(1, bob), 0u);
}

TEST_F(AuditTurnsTest, AuditMovesToANewPlayerAfterTenSeconds) {
  rooms.startAudit(kTicksPerSecond);
  const Client& ann = join("Ann");
  tick(AuditScheduler::kPeriod * kTicksPerSecond);
  const Client& bob = join("Bob");
  const Client& cal = join("Cal");
  tick(AuditScheduler::kPeriod * kTicksPerSecond);
  EXPECT_EQ(wanted(0, ann), kTicksPerSecond);
  EXPECT_EQ(wanted(1, bob), kTicksPerSecond);
  EXPECT_EQ(wanted(2, cal), 0u);
}

TEST_F(AuditTurnsTest, AuditMovesToTheNextPlayerAfterALeave) {
  options.grace = 0;
  rooms.startAudit(kTicksPerSecond);
  const Client& ann = join("Ann");
  tick(1);
  ann.drop();
  sessions.sweep();
  const Client& bob = join("Bob");
  tick(AuditScheduler::kPeriod * kTicksPerSecond);
  EXPECT_EQ(wanted(1, bob), kTicksPerSecond);
}

TEST_F(RoomManagerTest, LyingWorldAffectsOnlyScoresOfItsPlayers) {
  const Client& ann = join("Ann");
  const Client& bob = join("Bob");
  const std::uint32_t of_ann = ann.welcome().player();
  const std::uint32_t of_bob = bob.welcome().player();
  ports[0]->picture.players = {factsOf(of_ann, "Ann", 3)};
  ports[1]->picture.players = {factsOf(of_ann, "Cheat", -100), factsOf(of_bob, "\xff", 7)};
  for (std::uint32_t id = 1000; id < 1200; ++id)
    ports[1]->picture.players.push_back(factsOf(id, std::string(64, 'x'), 9));
  sendList();
  const std::vector<std::string> honest{"Ann=3", "Bob=7"};
  EXPECT_EQ(listOf(ann), honest);
  EXPECT_EQ(listOf(bob), honest);
}

TEST_F(RoomManagerTest, PlayersAreListedOnceTheirWorldHasThem) {
  const Client& ann = join("Ann");
  const Client& bob = join("Bob");
  ports[0]->picture.players = {factsOf(ann.welcome().player(), "Ann", 0)};
  sendList();
  EXPECT_EQ(listOf(ann), std::vector<std::string>{"Ann=0"});
  EXPECT_TRUE(listOf(bob).empty());
}

}  // namespace
}  // namespace naiad
