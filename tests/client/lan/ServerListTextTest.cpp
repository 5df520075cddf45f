#include <gtest/gtest.h>

#include "client/lan/DiscoveredServers.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

DiscoveredServer listed(const std::string& name) {
  DiscoveredServer server;
  server.name = name;
  server.game = "hello";
  server.address = {"192.168.1.5", 9877};
  server.protocol = kProtocolVersion;
  server.players = 3;
  server.max_players = 16;
  return server;
}

TEST(ServerListText, TextHasColumnsAndALink) {
  DiscoveredServer full = listed("b");
  full.players = 16;
  const std::string key = full.key.text();
  EXPECT_EQ(serversAsText({listed("Ann's"), full}),
            "NAME   GAME   PLAYERS  NOTE  SERVER\n"
            "Ann's  hello  3/16           naiad://192.168.1.5:9877#" +
                key +
                "\n"
                "b      hello  16/16    full  naiad://192.168.1.5:9877#" +
                key + "\n");
}

TEST(ServerListText, AnEmptyListSaysWhatToDo) {
  const std::string text = serversAsText({});
  EXPECT_NE(text.find("dfserver --game"), std::string::npos);
  EXPECT_NE(text.find("dfclient HOST"), std::string::npos);
  EXPECT_EQ(serversAsJson({}), "[]\n");
}

TEST(ServerListText, NotesShowPasswordFullAndOtherVersion) {
  DiscoveredServer server = listed("a");
  EXPECT_EQ(restrictionsText(server), "");
  server.requires_password = true;
  EXPECT_EQ(restrictionsText(server), "password");
  server.players = server.max_players;
  EXPECT_EQ(restrictionsText(server), "full");
  server.protocol = kProtocolVersion + 1;
  EXPECT_EQ(restrictionsText(server), "version " + std::to_string(kProtocolVersion + 1));
}

TEST(ServerListText, JsonHasEveryField) {
  DiscoveredServer zoned = listed("b");
  zoned.address = {"fe80::5%eth0", 9876};
  zoned.requires_password = true;
  const std::string key = zoned.key.text();
  EXPECT_EQ(
      serversAsJson({listed("a\"\\"), zoned}),
      "[{\"name\": \"a\\\"\\\\\", \"game\": \"hello\", \"players\": 3, \"max_players\": 16, \"password\": "
      "false, "
      "\"protocol\": " +
          std::to_string(kProtocolVersion) + ", \"address\": \"192.168.1.5:9877\", \"key\": \"" + key +
          "\", \"link\": \"naiad://192.168.1.5:9877#" + key +
          "\"},\n "
          "{\"name\": \"b\", \"game\": \"hello\", \"players\": 3, \"max_players\": 16, \"password\": true, "
          "\"protocol\": " +
          std::to_string(kProtocolVersion) + ", \"address\": \"[fe80::5%eth0]:9876\", \"key\": \"" + key +
          "\", \"link\": null}]\n");
}

}  // namespace
}  // namespace naiad
