#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "Clients.h"
#include "host/rooms/SessionTable.h"

namespace naiad {
namespace {

using test::Client;

class SessionTableTest : public testing::Test {
 protected:
  Client& connect(const std::string& address = "192.0.2.1:1") {
    Client& client = clients.emplace_back();
    client.address = address;
    table.add(std::make_unique<test::FakeChannel>(client), events(), now);
    return client;
  }
  Client& play(const std::string& address = "192.0.2.1:1") {
    Client& client = connect(address);
    client.greet(test::helloOf("Ann"));
    return client;
  }
  Session::Events events() {
    return {[this](Session& session, const wire::Hello&) {
              if (!judges) return;
              wire::Welcome welcome;
              welcome.set_player(++players);
              session.setGrace(std::chrono::seconds(60));
              session.welcome(welcome);
            },
            [](Session&, const std::string&) {}, [](Session&) {}, [this] { return now; }};
  }

  SessionTable::Clock::time_point now = SessionTable::Clock::now();
  std::deque<Client> clients;
  Counters counters;
  std::vector<std::uint64_t> removed;
  std::uint32_t players = 0;
  bool judges = true;  ///< true: hellos are answered at once
  SessionTable table{3, counters, [this](Session& session) { removed.push_back(session.id()); }};
};

TEST_F(SessionTableTest, FindsSessionsByIdAndCountsPlayers) {
  play();
  connect();
  EXPECT_EQ(table.find(1)->player(), 1u);
  EXPECT_NE(table.find(2), nullptr);
  EXPECT_EQ(table.find(3), nullptr);
  EXPECT_EQ(table.playingCount(), 1u);
  EXPECT_EQ(counters.connections, 2u);
}

TEST_F(SessionTableTest, DetachedSessionStillPlaysButIsNotConnected) {
  play().drop();
  play();
  EXPECT_EQ(table.playingCount(), 2u);
  EXPECT_EQ(table.connectedCount(), 1u);
}

TEST_F(SessionTableTest, FullTableEvictsTheOldestSilentConnection) {
  play();
  Client& silent = connect();
  connect();
  connect();
  EXPECT_TRUE(silent.destroyed);
  EXPECT_EQ(removed, std::vector<std::uint64_t>{2});
  EXPECT_EQ(table.find(2), nullptr);
  EXPECT_NE(table.find(4), nullptr);
  EXPECT_EQ(counters.connections_rejected, 1u);
}

TEST_F(SessionTableTest, EvictionPrefersTheAddressWithMostConnections) {
  Client& old = connect("198.51.100.1:1");
  Client& first = connect("192.0.2.1:1");
  Client& second = connect("192.0.2.1:2");
  Client& newcomer = connect("203.0.113.1:1");
  EXPECT_TRUE(first.destroyed);
  EXPECT_FALSE(old.destroyed || second.destroyed || newcomer.destroyed);
}

TEST_F(SessionTableTest, EvictionCountsAddressesOfANetworkTogether) {
  Client& old = connect("198.51.100.1:1");
  for (int i = 1; i < 50; ++i) connect("192.0.2." + std::to_string(i) + ":1");
  EXPECT_FALSE(old.destroyed);
}

TEST_F(SessionTableTest, EvictionCountsTheNewConnectionToItsNetwork) {
  Client& old = connect("198.51.100.1:1");
  Client& first = connect("192.0.2.1:1");
  connect("203.0.113.1:1");
  connect("192.0.2.2:1");
  EXPECT_TRUE(first.destroyed);
  EXPECT_FALSE(old.destroyed);
}

TEST_F(SessionTableTest, ClientWithAPendingHelloIsNotEvicted) {
  judges = false;
  Client& judged = connect();
  judged.greet(test::helloOf("Ann"));
  Client& silent = connect();
  for (int i = 0; i < 10; ++i) connect();
  EXPECT_TRUE(silent.destroyed);
  EXPECT_FALSE(judged.destroyed);
}

TEST_F(SessionTableTest, PlayersAreNotReplacedByNewConnections) {
  for (int i = 0; i < 3; ++i) play();
  EXPECT_TRUE(connect().destroyed);
  EXPECT_TRUE(removed.empty());
  EXPECT_EQ(table.playingCount(), 3u);
  EXPECT_EQ(counters.connections_rejected, 1u);
}

AddressPrefix prefixOf(const std::string& address) {
  return AddressPrefix::ofEndpoint(address).value_or(AddressPrefix());
}

/// Players on a full server. Those of the crowd have different addresses of one /64; every other player has
/// an address of their own.
struct FullServer {
  std::size_t places;
  std::size_t crowd;  ///< size of the crowd
  std::chrono::seconds idle;
  bool makes_place;
};

class FullServerTest : public SessionTableTest, public testing::WithParamInterface<FullServer> {};

TEST_P(FullServerTest, IdlePlayerOfAQuarterMakesPlace) {
  const auto [places, crowd, idle, makes_place] = GetParam();
  table.setMaxSessions(places);
  for (std::size_t i = 0; i < places; ++i) {
    const std::string number = std::to_string(i + 1);
    play(i < crowd ? "[2001:db8:0:1::" + number + "]:1" : "198.51.100." + number + ":1");
  }
  now += std::chrono::seconds(1);
  for (std::size_t i = 0; i < crowd; i += 2) clients[i].say("here", 1);
  now += idle - std::chrono::seconds(1);
  EXPECT_FALSE(table.makePlace(prefixOf("[2001:db8:0:1::ffff]:1"), places, now)) << "of the crowd";
  EXPECT_FALSE(table.makePlace(prefixOf("203.0.113.1:1"), places - 1, now)) << "more players than places";
  EXPECT_EQ(table.makePlace(prefixOf("203.0.113.1:1"), places, now), makes_place);
  EXPECT_EQ(table.playingCount(), places - (makes_place ? 1 : 0));
  EXPECT_EQ(counters.idle_kicks, makes_place ? 1u : 0u);
  for (std::size_t i = 0; i < places; ++i)
    EXPECT_EQ(clients[i].sent.back().has_goodbye(), makes_place && i == 1) << i;
}

constexpr std::chrono::seconds kMinute{60};

INSTANTIATE_TEST_SUITE_P(Crowds, FullServerTest,
                         testing::Values(FullServer{64, 15, kMinute, false},
                                         FullServer{64, 16, kMinute, true},
                                         FullServer{64, 16, kMinute - std::chrono::seconds(1), false},
                                         FullServer{64, 16, kMinute + std::chrono::seconds(1), true},
                                         FullServer{64, 64, kMinute, true},
                                         FullServer{64, 2, 100 * kMinute, false},
                                         FullServer{8, 2, kMinute, true}, FullServer{9, 2, kMinute, false},
                                         FullServer{9, 3, kMinute, true}, FullServer{4, 2, kMinute, true}));

TEST_F(SessionTableTest, AbsentPlayersOfACrowdMakePlaceToo) {
  for (int i = 0; i < 3; ++i) play().drop();
  now += kMinute;
  EXPECT_TRUE(table.makePlace(prefixOf("203.0.113.1:1"), 3, now));
  EXPECT_EQ(table.playingCount(), 2u);
}

// They have no addresses until they return, which must not look like one crowded address.
TEST_F(SessionTableTest, RestoredPlayersKeepTheirPlaces) {
  for (std::uint32_t player = 1; player <= 3; ++player) {
    wire::Welcome welcome;
    welcome.set_player(player);
    table.addDetached(now).restore(welcome, events());
  }
  now += 10 * kMinute;
  EXPECT_FALSE(table.makePlace(prefixOf("203.0.113.1:1"), 3, now));
  EXPECT_EQ(table.playingCount(), 3u);
}

TEST_F(SessionTableTest, EndedSessionIsDestroyedOnlyBySweep) {
  Client& client = connect();
  client.drop();
  EXPECT_FALSE(table.isEmpty());
  table.sweep();
  EXPECT_TRUE(table.isEmpty());
  EXPECT_EQ(removed, std::vector<std::uint64_t>{1});
}

}  // namespace
}  // namespace naiad
