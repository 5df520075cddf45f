#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "Clients.h"
#include "host/rooms/SessionTable.h"
#include "naiad.pb.h"

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
