// The list of servers, built from bus messages, and the choice of a server for a player.
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "server/directory/FleetList.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr FleetList::Time kStart{};

Presence presenceOf(const std::string& id, std::uint32_t players = 0, std::uint32_t places = 16) {
  Presence presence;
  presence.id = id;
  presence.name = "Server " + id;
  presence.game = "tron";
  presence.host = id + ".example";
  presence.port = 9876;
  presence.key = std::string(64, 'a');
  presence.protocol = 4;
  presence.players = players;
  presence.max_players = places;
  return presence;
}

void put(FleetList& list, const Presence& presence, FleetList::Time now = kStart) {
  list.put(presenceSubject(presence.id), presence.payload(), now);
}

std::string chosen(FleetList& list, const FleetList::Wish& wish = {"", 4}) {
  const FleetList::Place place = list.choose(wish);
  if (!place) return "";
  return place.p_server->id + (place.room.empty() ? "" : "/" + place.room);
}

TEST(FleetListTest, ServerExpiresAfterSixSilentSeconds) {
  FleetList list;
  EXPECT_TRUE(list.put(presenceSubject("a"), presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.put(presenceSubject("a"), presenceOf("a").payload(), kStart + 2s)) << "it is not new";
  put(list, presenceOf("b"), kStart + 4s);
  EXPECT_TRUE(list.removeSilent(kStart + 7s).empty());
  EXPECT_EQ(list.removeSilent(kStart + 8s), std::vector<std::string>{"a"});
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list.counters().expired, 1u);
  EXPECT_TRUE(list.put(presenceSubject("a"), presenceOf("a").payload(), kStart + 9s)) << "it is back";
}

TEST(FleetListTest, ResettingTimeoutsGivesServersAnotherSixSeconds) {
  FleetList list;
  put(list, presenceOf("a"));
  list.forgiveSilence(kStart + 60s);
  EXPECT_TRUE(list.removeSilent(kStart + 65s).empty());
  EXPECT_EQ(list.removeSilent(kStart + 66s).size(), 1u);
}

TEST(FleetListTest, PresenceUnderAnotherSubjectIsIgnoredAndCounted) {
  FleetList list;
  EXPECT_FALSE(list.put(presenceSubject("b"), presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.put("naiad.results.a", presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.put(presenceSubject("a"), "{}", kStart));
  EXPECT_EQ(list.size(), 0u);
  EXPECT_EQ(list.counters().foreign, 2u);
  EXPECT_EQ(list.counters().unreadable, 1u);
}

TEST(FleetListTest, ServerFloodDoesNotEvictAListedServer) {
  FleetList list;
  put(list, presenceOf("honest"));
  for (std::size_t i = 0; i < 2 * FleetList::kMaxServers; ++i) put(list, presenceOf("x" + std::to_string(i)));
  EXPECT_EQ(list.size(), FleetList::kMaxServers);
  EXPECT_EQ(list.counters().crowded, FleetList::kMaxServers + 1);
  put(list, presenceOf("honest", 7));
  EXPECT_EQ(list.servers().front().players, 7u);
}

TEST(FleetListTest, ChoosesFullestUncrowdedServerElseTheEmptiest) {
  FleetList list;
  put(list, presenceOf("a", 3));
  put(list, presenceOf("b", 9));
  put(list, presenceOf("c", 14));
  EXPECT_EQ(chosen(list), "b") << "the fullest that is calm";
  put(list, presenceOf("a", 12));
  put(list, presenceOf("b", 13));
  EXPECT_EQ(chosen(list), "a") << "none is calm";
}

TEST(FleetListTest, ChosenSlotIsReservedUntilTheThirdReport) {
  FleetList list;
  put(list, presenceOf("a", 0, 4));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(chosen(list), "a");
  EXPECT_EQ(chosen(list), "") << "four were sent there";
  put(list, presenceOf("a", 1, 4), kStart + 2s);
  EXPECT_EQ(chosen(list), "") << "the others may be on their way";
  put(list, presenceOf("a", 1, 4), kStart + 4s);
  EXPECT_EQ(chosen(list), "") << "on a busy machine";
  put(list, presenceOf("a", 1, 4), kStart + 6s);
  EXPECT_EQ(chosen(list), "a") << "they did not come";
}

TEST(FleetListTest, PlayersAreSentOnlyWhereTheyCanPlay) {
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
      {"a password", [](Presence& one) { one.asks_password = true; }},
      {"no address", [](Presence& one) { one.host.clear(); }},
      {"no key", [](Presence& one) { one.key.clear(); }},
      {"a port of the system", [](Presence& one) { one.port = 25; }},
  };
  for (const Case& one : cases) {
    FleetList list;
    Presence presence = presenceOf("a");
    put(list, presence);
    ASSERT_EQ(chosen(list, {"tron", 4}), "a");
    one.spoil(presence);
    put(list, presence);
    put(list, presence);
    EXPECT_EQ(chosen(list, {"tron", 4}), "") << one.why;
  }
  FleetList list;
  put(list, presenceOf("a"));
  EXPECT_EQ(chosen(list, {"tron", 4, "a"}), "") << "back to where they come from";
}

FleetList::Wish wishFor(const std::string& game, const std::string& room = "") {
  return {game, 4, "", room};
}

TEST(FleetListTest, ChoosesARoomOfTheGameWithFreeSlots) {
  Presence server = presenceOf("a", 3, 32);
  server.game = "lobby";
  server.rooms = {
      {"hall", "lobby", 0, 32}, {"duel", "tron", 2, 2}, {"big", "tron", 1, 8}, {"arcade", "maze", 0, 2}};
  FleetList list;
  put(list, server);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/big");
  EXPECT_EQ(chosen(list, wishFor("", "arcade")), "a/arcade");
  EXPECT_EQ(chosen(list, wishFor("maze", "arcade")), "a/arcade");
  EXPECT_EQ(chosen(list, wishFor("maze")), "") << "both places of that room are taken";
  EXPECT_EQ(chosen(list), "a/hall") << "where players begin";
  EXPECT_EQ(chosen(list, wishFor("", "duel")), "") << "it is full";
  EXPECT_TRUE(list.plays(wishFor("", "duel")));
  EXPECT_EQ(chosen(list, wishFor("tron", "arcade")), "") << "it plays another game";
  EXPECT_FALSE(list.plays(wishFor("tron", "arcade")));
  EXPECT_FALSE(list.plays(wishFor("chess")));
  put(list, presenceOf("b", 0, 2));
  EXPECT_FALSE(list.plays(wishFor("", "Big"))) << "names are as they are, and b has no rooms";
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/big") << "company, which a has";
  EXPECT_EQ(list.roomiest({"tron", 4, "b"}).room, "big");
}

TEST(FleetListTest, ChosenRoomSlotIsReservedUntilTheThirdReport) {
  Presence server = presenceOf("a", 0, 32);
  server.rooms = {{"hall", "lobby", 0, 32}, {"one", "tron", 0, 1}, {"two", "tron", 0, 1}};
  FleetList list;
  put(list, server);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/one");
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/two");
  EXPECT_EQ(chosen(list, wishFor("tron")), "");
  put(list, server, kStart + 2s);
  EXPECT_EQ(chosen(list, wishFor("tron")), "") << "they may be on their way";
  put(list, server, kStart + 4s);
  put(list, server, kStart + 6s);
  EXPECT_EQ(chosen(list, wishFor("tron")), "a/one") << "they did not come";
  server.rooms.pop_back();
  put(list, server, kStart + 8s);
  EXPECT_EQ(chosen(list, wishFor("", "two")), "") << "it is gone";
}

TEST(FleetListTest, AFullServerSendsToNoneOfItsRooms) {
  Presence server = presenceOf("a", 4, 4);
  server.rooms = {{"hall", "lobby", 0, 32}};
  FleetList list;
  put(list, server);
  EXPECT_EQ(chosen(list), "");
}

TEST(FleetListTest, NoServerGetsMorePlayersThanItHasSlots) {
  SplitMix64 random(3);
  FleetList list;
  std::map<std::string, std::uint32_t> sent;
  for (int i = 0; i < 200; ++i) put(list, presenceOf("s" + std::to_string(i), 0, random.next() % 8));
  for (int i = 0; i < 2000; ++i) ++sent[chosen(list)];
  for (const Presence& one : list.servers()) EXPECT_LE(sent[one.id], one.max_players) << one.id;
  EXPECT_GT(sent[""], 0u) << "all are full in the end";
}

}  // namespace
}  // namespace naiad
