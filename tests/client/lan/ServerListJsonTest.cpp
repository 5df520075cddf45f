#include <gtest/gtest.h>

#include "../../support/HostileTexts.h"
#include "client/lan/DiscoveredServers.h"
#include "client/lan/ListDownload.h"
#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

const std::string kListKey = "abcdefghijklmnopqrstuvwxya";
const std::string kListLink = "naiad://game.example:9877#" + kListKey;

std::vector<DiscoveredServer> serversOf(const std::string& json) {
  const auto servers = readServerList(json);
  EXPECT_TRUE(servers) << json;
  return servers ? servers->sorted() : std::vector<DiscoveredServer>{};
}

TEST(ServerListJson, ReadsOneServerOrAnArray) {
  const std::string one =
      R"({"name": "Ann's", "game": "hello", "players": 3, "max_players": 16, "password": true,
    "protocol": 4, "version": "0.1.0", "link": ")" +
      kListLink + "\"}\n";
  for (const std::string& json : {one, "[" + one + "]", " [ " + one + " , " + one + " ] "}) {
    const auto servers = serversOf(json);
    ASSERT_EQ(servers.size(), 1u) << json;
    EXPECT_EQ(servers[0].name, "Ann's");
    EXPECT_EQ(servers[0].game, "hello");
    EXPECT_EQ(servers[0].players, 3);
    EXPECT_EQ(servers[0].max_players, 16);
    EXPECT_TRUE(servers[0].requires_password);
    EXPECT_EQ(servers[0].protocol, 4u);
    EXPECT_EQ(servers[0].link(), kListLink);
  }
  EXPECT_EQ(serversOf("[]").size(), 0u);
}

TEST(ServerListJson, PrintedJsonIsReadBackUnchanged) {
  const auto servers = serversOf("[{\"name\": \"na\u00efve\", \"link\": \"" + kListLink + "\"}]");
  EXPECT_EQ(serversOf(serversAsJson(servers)), servers);
}

TEST(ServerListJson, UnknownOrMistypedMembersAreIgnored) {
  const auto servers =
      serversOf(R"([{"extra": {"a": [1, {"b": null}], "c": -1.5e3}, "name": 7, "players": "many",
    "password": 1, "link": ")" +
                kListLink + "\"}]");
  ASSERT_EQ(servers.size(), 1u);
  EXPECT_EQ(servers[0].name, "");
  EXPECT_EQ(servers[0].players, 0);
  EXPECT_FALSE(servers[0].requires_password);
  EXPECT_TRUE(servers[0].isPlayable()) << "no protocol is said";
}

TEST(ServerListJson, NumbersOutOfRangeAreClamped) {
  const auto servers = serversOf(R"({"players": -3, "max_players": 1e300, "link": ")" + kListLink + "\"}");
  ASSERT_EQ(servers.size(), 1u);
  EXPECT_EQ(servers[0].players, 0);
  EXPECT_EQ(servers[0].max_players, 65535);
}

TEST(ServerListJson, ServersWithoutAValidLinkAreDropped) {
  for (const std::string& link :
       {std::string(), std::string("naiad://game.example"), "https://game.example#" + kListKey,
        "naiad://-x#" + kListKey, "naiad://game.example/room#" + kListKey})
    EXPECT_EQ(serversOf("[{\"link\": \"" + link + "\"}]").size(), 0u) << link;
  EXPECT_EQ(serversOf("[{}, {\"link\": null}]").size(), 0u);
}

TEST(ServerListJson, EscapesAreDecodedAndTextsSanitized) {
  const auto nameOf = [](const std::string& quoted) {
    const auto servers = serversOf("{\"link\": \"" + kListLink + "\", \"name\": " + quoted + "}");
    return servers.empty() ? "none" : servers[0].name;
  };
  EXPECT_EQ(nameOf(R"("a\"\\\/b")"), "a\"\\/b");
  EXPECT_EQ(nameOf(R"("\u0041\u00ef\u2588")"), "A\u00ef\u2588");
  EXPECT_EQ(nameOf(R"("\u001b[2J\n")"), "?[2J ");
  EXPECT_EQ(nameOf(R"("\ud83d\ude00x")"), "?x");
  for (const test::HostileText& text : test::hostileTexts()) {
    const std::string name = nameOf(Json(text.bytes).toString(Json::Style::kAscii));
    EXPECT_EQ(safeText(name, kMaxLanText), name) << text.what;
  }
}

TEST(ServerListJson, InvalidListsAreRejected) {
  for (const char* p_text :
       {"", "<html>", "1", "\"a\"", "null", "[1]", "[{}", "[{}]x", "{\"a\":1,}", "{a:1}"})
    EXPECT_FALSE(readServerList(p_text)) << p_text;
}

TEST(ServerListJson, DepthIsBounded) {
  std::string deep(100'000, '[');
  EXPECT_FALSE(readServerList(deep));
  EXPECT_FALSE(readServerList("{\"a\":" + deep));
  EXPECT_TRUE(readServerList("[{\"a\":[[[[[1]]]]]}]"));
}

TEST(ServerListJson, MutatedListsAreRejectedOrSafe) {
  SplitMix64 random(5);
  const std::string json =
      R"([{"name": "a\u00ef", "game": "b", "players": 1.5e1, "x": [true, null], "link": ")" + kListLink +
      "\"}]";
  for (int i = 0; i < 20'000; ++i) {
    std::string other = json;
    for (std::size_t n = 1 + random.below(3); n > 0; --n)
      other[random.below(other.size())] = static_cast<char>(random.next());
    const auto servers = readServerList(other);
    if (!servers) continue;
    for (const DiscoveredServer& server : servers->sorted()) {
      ASSERT_EQ(safeText(server.name, kMaxLanText), server.name);
      ASSERT_NE(server.link(), "");
    }
  }
}

// ---- addresses --------------------------------------------------------------------------------------------

TEST(ListUrl, AcceptsOnlyHttps) {
  const auto url = ListUrl::parse("https://lists.example:8443/naiad.json?a=b#c");
  ASSERT_TRUE(url);
  EXPECT_EQ(*url, (ListUrl{"lists.example", 8443, "/naiad.json?a=b"}));
  EXPECT_EQ(url->hostText(), "lists.example:8443");
  EXPECT_EQ(ListUrl::parse("https://lists.example")->target, "/");
  EXPECT_EQ(ListUrl::parse("https://lists.example?a")->target, "/?a");
  EXPECT_EQ(ListUrl::parse("https://[::1]/")->hostText(), "[::1]");
  for (const char* p_text :
       {"http://lists.example/", "ftp://lists.example/", "lists.example", "https://", "https:///a",
        "https://user@lists.example/", "https://-x/", "https://lists.example/ a",
        "https://lists.example/\r\nHost: x", "https://lists.example:0/", "https://\u00fc.example/"})
    EXPECT_FALSE(ListUrl::parse(p_text)) << p_text;
  EXPECT_FALSE(ListUrl::parse("https://lists.example/" + std::string(2000, 'a')));
}

TEST(ListUrl, RedirectsMustStayOnHttps) {
  const ListUrl url = *ListUrl::parse("https://lists.example/a");
  EXPECT_EQ(url.redirected("/b?c#d")->target, "/b?c");
  EXPECT_EQ(url.redirected("/b")->host, "lists.example");
  EXPECT_EQ(url.redirected("https://other.example/b")->host, "other.example");
  for (const char* p_text :
       {"http://lists.example/b", "//other.example/b", "b", "", "file:///etc/passwd", "/b\r\nX: y"})
    EXPECT_FALSE(url.redirected(p_text)) << p_text;
}

}  // namespace
}  // namespace naiad
