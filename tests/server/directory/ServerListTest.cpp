// The server list of a directory, read with the code of the client.
#include <gtest/gtest.h>

#include <string>

#include "SamplePresence.h"
#include "client/lan/DiscoveredServers.h"
#include "client/lan/ListDownload.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

Presence listedServer(const std::string& id) {
  Presence presence = test::presenceOf(id, 3);
  presence.name = "B\xc3\xa9rlin \"1\"";
  presence.host = "2001:db8::7";
  presence.port = 9877;
  presence.requires_password = true;
  return presence;
}

TEST(ServerListTest, ClientReadsEveryWrittenField) {
  const Presence server = listedServer("a");
  const auto read = readServerList(serverListText({server}));
  ASSERT_TRUE(read && read->size() == 1) << serverListText({server});
  const DiscoveredServer found = read->sorted().front();
  EXPECT_EQ(found.name, server.name);
  EXPECT_EQ(found.game, "tron");
  EXPECT_EQ(found.address.host, "2001:db8::7");
  EXPECT_EQ(found.address.port, 9877);
  EXPECT_EQ(found.key, ShortKey::of(*Fingerprint::parse(server.key)));
  EXPECT_EQ(found.protocol, 4u);
  EXPECT_EQ(found.players, 3);
  EXPECT_EQ(found.max_players, 16);
  EXPECT_TRUE(found.requires_password);
}

TEST(ServerListTest, RoomsAreListedWithinTheClientsSizeLimit) {
  Presence server = listedServer("a");
  server.rooms = {{"hall", "lobby", 3, 64}, {"duel", "tron", 0, 2}};
  EXPECT_TRUE(test::has(serverListText({server}),
                        R"("rooms": [{"name": "hall", "game": "lobby", "players": 3, "max_players": 64}, )"
                        R"({"name": "duel", "game": "tron", "players": 0, "max_players": 2}])"));
  EXPECT_TRUE(readServerList(serverListText({server})));
  server.rooms.clear();
  EXPECT_FALSE(test::has(serverListText({server}), "rooms"));
  for (int i = 0; i < 64; ++i) server.rooms.push_back({"r" + std::to_string(i), "g", 0, 1});
  server.name = server.game = std::string(Presence::kMaxName, '"');
  const std::string text = serverListText(std::vector<Presence>(kMaxListedServers, server));
  EXPECT_LE(text.size(), kMaxListBytes);
  const auto read = readServerList(text);
  EXPECT_TRUE(read && read->size() > 0);
}

TEST(ServerListTest, EmptyListIsValid) {
  const auto read = readServerList(serverListText({}));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size(), 0u);
}

TEST(ServerListTest, ClosedAndUnreachableServersAreOmitted) {
  Presence closed = listedServer("a");
  closed.is_open = false;
  Presence nowhere = listedServer("b");
  nowhere.host.clear();
  Presence keyless = listedServer("c");
  keyless.key.clear();
  const auto read = readServerList(serverListText({closed, nowhere, keyless, listedServer("d")}));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size(), 1u);
}

TEST(ServerListTest, FullListKeepsServersWithFreeSlots) {
  std::vector<Presence> servers;
  for (int i = 0; i < 4096; ++i) {
    Presence server = listedServer("s" + std::to_string(i));
    server.name = server.game = std::string(Presence::kMaxName, '"');
    server.host = std::string(60, 'h') + "." + std::string(60, 'o') + "." + std::to_string(i) + ".example";
    server.max_players = i % 100 == 0 ? 1000 : 3;
    servers.push_back(server);
  }
  const std::string text = serverListText(servers);
  EXPECT_LE(text.size(), kMaxListBytes);
  std::size_t rows = 0;
  std::size_t roomy = 0;
  for (std::size_t at = 0; (at = text.find("\"link\"", at)) != std::string::npos; ++at) ++rows;
  for (std::size_t at = 0; (at = text.find("\"max_players\": 1000", at)) != std::string::npos; ++at) ++roomy;
  EXPECT_EQ(rows, kMaxListedServers);
  EXPECT_EQ(roomy, 41u);
}

}  // namespace
}  // namespace naiad
