// The list of servers, built from bus messages, and the choice of a server for a player.
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "SamplePresence.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::handleHeartbeat;
using test::presenceOf;

constexpr FleetRegistry::Time kStart{};

std::string chosen(FleetRegistry& list, const FleetRegistry::PlayerRequest& wish = {"", 4}) {
  const FleetRegistry::Assignment place = list.choose(wish);
  if (!place) return "";
  return place.p_server->id + (place.room.empty() ? "" : "/" + place.room);
}

TEST(FleetRegistryTest, ServerExpiresAfterSixSilentSeconds) {
  FleetRegistry list;
  EXPECT_TRUE(list.handleHeartbeat(presenceSubject("a"), presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.handleHeartbeat(presenceSubject("a"), presenceOf("a").payload(), kStart + 2s))
      << "it is not new";
  handleHeartbeat(list, presenceOf("b"), kStart + 4s);
  EXPECT_TRUE(list.removeExpired(kStart + 7s).empty());
  EXPECT_EQ(list.removeExpired(kStart + 8s), std::vector<std::string>{"a"});
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list.counters().expired, 1u);
  EXPECT_TRUE(list.handleHeartbeat(presenceSubject("a"), presenceOf("a").payload(), kStart + 9s))
      << "it is back";
}

TEST(FleetRegistryTest, ExcusedSilenceGivesServersAnotherSixSeconds) {
  FleetRegistry list;
  handleHeartbeat(list, presenceOf("a"));
  list.excuseSilence(kStart + 60s, 1min);
  EXPECT_EQ(list.removeExpired(kStart + 60s).size(), 1u) << "silent for too long to be excused";
  handleHeartbeat(list, presenceOf("a"));
  list.excuseSilence(kStart + 60s, 2min);
  EXPECT_TRUE(list.removeExpired(kStart + 65s).empty());
  EXPECT_EQ(list.removeExpired(kStart + 66s).size(), 1u);
}

TEST(FleetRegistryTest, PresenceUnderAnotherSubjectIsIgnoredAndCounted) {
  FleetRegistry list;
  EXPECT_FALSE(list.handleHeartbeat(presenceSubject("b"), presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.handleHeartbeat("naiad.results.a", presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.handleHeartbeat(presenceSubject("a"), "{}", kStart));
  EXPECT_EQ(list.size(), 0u);
  EXPECT_EQ(list.counters().wrong_subject, 2u);
  EXPECT_EQ(list.counters().unreadable, 1u);
}

TEST(FleetRegistryTest, ServerFloodDoesNotEvictAListedServer) {
  FleetRegistry list;
  handleHeartbeat(list, presenceOf("honest"));
  for (std::size_t i = 0; i < 2 * FleetRegistry::kMaxServers; ++i)
    handleHeartbeat(list, presenceOf("x" + std::to_string(i)));
  EXPECT_EQ(list.size(), FleetRegistry::kMaxServers);
  EXPECT_EQ(list.counters().over_limit, FleetRegistry::kMaxServers + 1);
  handleHeartbeat(list, presenceOf("honest", 7));
  EXPECT_EQ(list.servers().front().players, 7u);
}

TEST(FleetRegistryTest, ChoosesFullestUncrowdedServerElseTheEmptiest) {
  FleetRegistry list;
  handleHeartbeat(list, presenceOf("a", 3));
  handleHeartbeat(list, presenceOf("b", 9));
  handleHeartbeat(list, presenceOf("c", 14));
  EXPECT_EQ(chosen(list), "b") << "the fullest that is calm";
  handleHeartbeat(list, presenceOf("a", 12));
  handleHeartbeat(list, presenceOf("b", 13));
  EXPECT_EQ(chosen(list), "a") << "none is calm";
}

TEST(FleetRegistryTest, ChosenSlotIsReservedUntilTheThirdReport) {
  FleetRegistry list;
  handleHeartbeat(list, presenceOf("a", 0, 4));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(chosen(list), "a");
  EXPECT_EQ(chosen(list), "") << "four were sent there";
  handleHeartbeat(list, presenceOf("a", 1, 4), kStart + 2s);
  EXPECT_EQ(chosen(list), "") << "the others may be on their way";
  handleHeartbeat(list, presenceOf("a", 1, 4), kStart + 4s);
  EXPECT_EQ(chosen(list), "") << "on a busy machine";
  handleHeartbeat(list, presenceOf("a", 1, 4), kStart + 6s);
  EXPECT_EQ(chosen(list), "a") << "they did not come";
}

TEST(FleetRegistryTest, PlayersAreSentOnlyWhereTheyCanPlay) {
  struct Case {
    const char* why;
    void (*spoil)(Presence&);
  };
  const Case cases[] = {
      {"another game", [](Presence& one) { one.game = "maze"; }},
      {"another protocol", [](Presence& one) { one.protocol = 5; }},
      {"full", [](Presence& one) { one.players = one.max_players; }},
      {"more than full", [](Presence& one) { one.players = one.max_players + 3; }},
      {"closed", [](Presence& one) { one.is_open = false; }},
      {"a password", [](Presence& one) { one.requires_password = true; }},
      {"no address", [](Presence& one) { one.host.clear(); }},
      {"no key", [](Presence& one) { one.key.clear(); }},
      {"a port of the system", [](Presence& one) { one.port = 25; }},
  };
  for (const Case& one : cases) {
    FleetRegistry list;
    Presence presence = presenceOf("a");
    handleHeartbeat(list, presence);
    ASSERT_EQ(chosen(list, {"tron", 4}), "a");
    one.spoil(presence);
    handleHeartbeat(list, presence);
    handleHeartbeat(list, presence);
    EXPECT_EQ(chosen(list, {"tron", 4}), "") << one.why;
  }
  FleetRegistry list;
  handleHeartbeat(list, presenceOf("a"));
  EXPECT_EQ(chosen(list, {"tron", 4, "a"}), "") << "back to where they come from";
}

FleetRegistry::PlayerRequest wishFor(const std::string& game, const std::string& room = "") {
  return {game, 4, "", room};
}

TEST(FleetRegistryTest, ChoosesARoomOfTheGameWithFreeSlots) {
  Presence server = presenceOf("a", 3, 32);
  server.game = "lobby";
  server.rooms = {
      {"hall", "lobby", 0, 32}, {"duel", "tron", 2, 2}, {"big", "tron", 1, 8}, {"arcade", "maze", 0, 2}};
  FleetRegistry list;
  handleHeartbeat(list, server);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/big");
  EXPECT_EQ(chosen(list, wishFor("", "arcade")), "a/arcade");
  EXPECT_EQ(chosen(list, wishFor("maze", "arcade")), "a/arcade");
  EXPECT_EQ(chosen(list, wishFor("maze")), "") << "both places of that room are taken";
  EXPECT_EQ(chosen(list), "a/hall") << "where players begin";
  EXPECT_EQ(chosen(list, wishFor("", "duel")), "") << "it is full";
  EXPECT_TRUE(list.hasMatch(wishFor("", "duel")));
  EXPECT_EQ(chosen(list, wishFor("tron", "arcade")), "") << "it plays another game";
  EXPECT_FALSE(list.hasMatch(wishFor("tron", "arcade")));
  EXPECT_FALSE(list.hasMatch(wishFor("chess")));
  handleHeartbeat(list, presenceOf("b", 0, 2));
  EXPECT_FALSE(list.hasMatch(wishFor("", "Big"))) << "names are as they are, and b has no rooms";
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/big") << "company, which a has";
  EXPECT_EQ(list.leastLoaded({"tron", 4, "b"}).room, "big");
}

TEST(FleetRegistryTest, ChosenRoomSlotIsReservedUntilTheThirdReport) {
  Presence server = presenceOf("a", 0, 32);
  server.rooms = {{"hall", "lobby", 0, 32}, {"one", "tron", 0, 1}, {"two", "tron", 0, 1}};
  FleetRegistry list;
  handleHeartbeat(list, server);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/one");
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/two");
  EXPECT_EQ(chosen(list, wishFor("tron")), "");
  handleHeartbeat(list, server, kStart + 2s);
  EXPECT_EQ(chosen(list, wishFor("tron")), "") << "they may be on their way";
  handleHeartbeat(list, server, kStart + 4s);
  handleHeartbeat(list, server, kStart + 6s);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/one") << "they did not come";
  server.rooms.pop_back();
  handleHeartbeat(list, server, kStart + 8s);
  EXPECT_EQ(chosen(list, wishFor("", "two")), "") << "it is gone";
}

TEST(FleetRegistryTest, AFullServerSendsToNoneOfItsRooms) {
  Presence server = presenceOf("a", 4, 4);
  server.rooms = {{"hall", "lobby", 0, 32}};
  FleetRegistry list;
  handleHeartbeat(list, server);
  EXPECT_EQ(chosen(list), "");
}

TEST(FleetRegistryTest, NoServerGetsMorePlayersThanItHasSlots) {
  SplitMix64 random(3);
  FleetRegistry list;
  std::map<std::string, std::uint32_t> sent;
  for (int i = 0; i < 200; ++i)
    handleHeartbeat(list, presenceOf("s" + std::to_string(i), 0, random.next() % 8));
  for (int i = 0; i < 2000; ++i) ++sent[chosen(list)];
  for (const Presence& one : list.servers()) EXPECT_LE(sent[one.id], one.max_players) << one.id;
  EXPECT_GT(sent[""], 0u) << "all are full in the end";
}

}  // namespace
}  // namespace naiad
