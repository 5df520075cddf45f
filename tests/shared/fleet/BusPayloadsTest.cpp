// Payloads of servers on the bus: they survive a round trip, and payloads that no server writes are rejected.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

Presence fullPresence() {
  Presence presence;
  presence.id = "berlin-9876";
  presence.name = "B\xc3\xa9rlin \"1\"";
  presence.game = "tron";
  presence.host = "2001:db8::7";
  presence.port = 65'535;
  presence.key = std::string(64, 'a');
  presence.protocol = 4;
  presence.players = 3;
  presence.max_players = 64;
  presence.requires_password = true;
  presence.is_open = false;
  presence.rooms = {{"lobby", "lobby", 3, 64}, {"duel.2", "my_game-1.x", 0, 1'000'000}};
  return presence;
}

GameResult fullResult() {
  GameResult result;
  result.server = "berlin-9876";
  result.game = "tron";
  result.table = "rides";
  result.name = "\xc3\x84nn";
  result.points = -900'000'000'000'000;
  result.at = 1'800'000'000;
  result.round = "0123456789abcdef0123456789abcdef";
  result.tick = 4'000'000'000;
  result.number = 255;
  result.recording = "2026-11-26.dfr";
  return result;
}

/// Returns the payload with another value for the member `name`.
std::string with(std::string payload, const std::string& name, const std::string& value) {
  const std::size_t begin = payload.find("\"" + name + "\":") + name.size() + 3;
  std::size_t end = begin;
  for (bool quoted = false; end < payload.size(); ++end) {
    const char c = payload[end];
    if (c == '\\') {
      ++end;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == ',' || c == '}')) {
      break;
    }
  }
  return payload.replace(begin, end - begin, value);
}

TEST(BusPayloads, SurviveTheRoundTrip) {
  EXPECT_EQ(Presence::parse(fullPresence().payload()), fullPresence());
  EXPECT_EQ(GameResult::parse(fullResult().payload()), fullResult());
  Presence least;
  least.id = "a";
  least.port = 1;
  least.protocol = 1;
  EXPECT_EQ(Presence::parse(least.payload()), least);
  EXPECT_EQ(fullResult().messageId(), "0123456789abcdef0123456789abcdef-4000000000-255");
}

TEST(BusPayloads, LongestPresenceFitsByDroppingRooms) {
  Presence presence = fullPresence();
  presence.id = std::string(kMaxServerId, 'x');
  presence.name = presence.game = std::string(Presence::kMaxName, '"');
  presence.host.clear();
  for (int label = 0; label < 50; ++label) presence.host += "host.";
  presence.host += "abc";
  presence.rooms.clear();
  for (std::size_t i = 0; i < kMaxRooms; ++i)
    presence.rooms.push_back({"room-" + std::to_string(i), "game-of-many-letters", 0, 64});
  ASSERT_LE(presence.payload().size(), kMaxBusPayload);
  const auto read = Presence::parse(presence.payload());
  ASSERT_TRUE(read);
  EXPECT_GT(read->rooms.size(), 20u) << "as many as fit";
  presence.rooms.resize(read->rooms.size());
  EXPECT_EQ(read, presence);
  EXPECT_GT(roomsText(read->rooms).size() + 40, kMaxRoomsText) << "and not one fewer";
}

TEST(BusPayloads, RoomWithAnUnwritableGameNameIsDropped) {
  Presence presence = fullPresence();
  presence.rooms = {{"one", "two words", 0, 1}, {"two", "", 0, 1}, {"three", "tron", 1, 2}};
  const auto read = Presence::parse(presence.payload());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->rooms, (std::vector<PresenceRoom>{{"three", "tron", 1, 2}}));
}

TEST(BusPayloads, MalformedRoomListsAreRefused) {
  const std::string good = fullPresence().payload();
  EXPECT_TRUE(Presence::parse(with(good, "rooms", "\"\""))) << "none";
  EXPECT_TRUE(Presence::parse(with(good, "rooms", "\"a=b:0/0\"")));
  std::istringstream lists(
      " |a|a=b|a=b:1|a=b:/|a=b:1/|a=b:1/2 | a=b:1/2|a=b:1/2  "
      "c=d:1/2|a=b:01/2|a=b:+1/2|a=b:-1/2|a=b:1/1000001|"
      "a=b:1/99999999999|=b:1/2|a=:1/2|-a=b:1/2|a/x=b:1/2|a=b c:1/2|a=b:1/2 A=c:1/2|a=b:1/2,c=d:1/2|"
      "a=\\u001b:1/2");
  for (std::string rooms; std::getline(lists, rooms, '|');)
    EXPECT_FALSE(Presence::parse(with(good, "rooms", "\"" + rooms + "\""))) << rooms;
  for (const char* const value : {"7", "true"}) EXPECT_FALSE(Presence::parse(with(good, "rooms", value)));
  std::string many;
  for (int i = 0; i < 65; ++i) many += (i > 0 ? " r" : "r") + std::to_string(i) + "=g:0/1";
  EXPECT_FALSE(Presence::parse(with(good, "rooms", "\"" + many + "\""))) << "more than a server has";
  const std::string longest = std::string(32, 'r') + "=" + std::string(65, 'g') + ":0/1";
  EXPECT_FALSE(Presence::parse(with(good, "rooms", "\"" + longest + "\"")));
}

/// Values that a member must not have.
struct Refused {
  const char* name;
  std::vector<const char*> values;
};

TEST(BusPayloads, InvalidFieldValuesAreRefused) {
  const std::string good = fullPresence().payload();
  const Refused bad_presences[] = {
      {"v", {"2"}},
      {"id", {"\"A\"", "\"a.b\"", "\"-a\"", "\"\"", "7"}},
      {"name", {"\"a\\nb\"", "\"\\u001b[2J\"", "null"}},
      {"host", {"\"-oProxyCommand=x\"", "\"user@host\"", "\"a b\"", "\"host:80\""}},
      {"port", {"0", "65536", "\"80\"", "80.0"}},
      {"key", {"\"abc\"", "true"}},
      {"protocol", {"0"}},
      {"players", {"-1", "1000001"}},
      {"password", {"1"}},
      {"open", {"\"yes\"", "{}", "[true]"}}};
  for (const auto& [name, values] : bad_presences) {
    for (const char* const value : values)
      EXPECT_FALSE(Presence::parse(with(good, name, value))) << with(good, name, value);
  }
  EXPECT_FALSE(Presence::parse(with(good, "key", "\"" + std::string(64, 'A') + "\""))) << "another spelling";
  const std::string result = fullResult().payload();
  const Refused bad_results[] = {{"server", {"\"a b\""}},
                                 {"table", {"\"\"", "\"a/b\""}},
                                 {"name", {"\"\"", "\"12345678901234567\""}},
                                 {"points", {"1000000000000001", "18446744073709551615", "1e3"}},
                                 {"at", {"-1"}},
                                 {"round", {"\"0123\""}},
                                 {"tick", {"-1", "4294967296"}},
                                 {"number", {"256"}},
                                 {"recording", {"\"a b\""}}};
  for (const auto& [name, values] : bad_results) {
    for (const char* const value : values)
      EXPECT_FALSE(GameResult::parse(with(result, name, value))) << with(result, name, value);
  }
}

TEST(BusPayloads, MissingRepeatedAndNestedMembersAreRefused) {
  const std::string good = fullPresence().payload();
  const std::string inside = good.substr(1);
  EXPECT_TRUE(Presence::parse("{\"region\":\"eu\",\"weight\":1.5,\"next\":null," + inside));
  EXPECT_FALSE(Presence::parse("{\"port\":80," + inside)) << "twice";
  EXPECT_FALSE(Presence::parse("{\"more\":{}," + inside));
  EXPECT_FALSE(Presence::parse("{\"more\":[]," + inside));
  EXPECT_FALSE(Presence::parse(good + "x"));
  EXPECT_FALSE(Presence::parse("{\"more\":\"" + std::string(kMaxBusPayload, 'x') + "\"," + inside));
  for (const std::string name : {"v", "id", "name", "game", "host", "port", "key", "protocol", "players",
                                 "max_players", "password", "open"}) {
    std::string without = good;
    without.replace(without.find("\"" + name + "\""), name.size() + 2, "\"other\"");
    EXPECT_FALSE(Presence::parse(without)) << name;
  }
}

TEST(BusPayloads, TruncatedPayloadsAreRefused) {
  for (const std::string& good : {fullPresence().payload(), fullResult().payload()}) {
    for (std::size_t size = 0; size < good.size(); ++size) {
      EXPECT_FALSE(Presence::parse(good.substr(0, size)));
      EXPECT_FALSE(GameResult::parse(good.substr(0, size)));
    }
  }
}

TEST(ServerId, IsOneTokenOfABusSubject) {
  EXPECT_TRUE(isServerId("a"));
  EXPECT_TRUE(isServerId("berlin-1-9876"));
  for (const std::string bad : {"", "-a", "A", "a.b", "a*", ">", "a b", "\xc3\xa4"})
    EXPECT_FALSE(isServerId(bad)) << bad;
  EXPECT_FALSE(isServerId(std::string(kMaxServerId + 1, 'a')));
  EXPECT_EQ(serverIdOf("My.Host-9876"), "my-host-9876");
  EXPECT_EQ(serverIdOf("...\xc3\xa4"), "server");
  EXPECT_TRUE(isServerId(serverIdOf(std::string(100, 'X'))));
}

}  // namespace
}  // namespace naiad
