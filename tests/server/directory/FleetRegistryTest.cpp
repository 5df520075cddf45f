// The list of servers, built from bus messages, and the choice of a server for a player. The list stays for
// some time when the bus is down.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "SamplePresence.h"
#include "host/fleet/Bus.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::handleHeartbeat;
using test::presenceOf;

constexpr FleetRegistry::Time kStart{};

struct FleetRegistryTest : testing::Test {
  FleetRegistry list;
};

std::string chosen(FleetRegistry& list, const FleetRegistry::PlayerRequest& wish = {"", 4}) {
  const FleetRegistry::Assignment place = list.choose(wish);
  if (!place) return "";
  return place.p_server->id + (place.room.empty() ? "" : "/" + place.room);
}

TEST_F(FleetRegistryTest, ServerExpiresAfterSixSilentSeconds) {
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

TEST_F(FleetRegistryTest, ExcusedSilenceGivesServersAnotherSixSeconds) {
  handleHeartbeat(list, presenceOf("a"));
  list.excuseSilence(kStart + 60s, 1min);
  EXPECT_EQ(list.removeExpired(kStart + 60s).size(), 1u) << "silent for too long to be excused";
  handleHeartbeat(list, presenceOf("a"));
  list.excuseSilence(kStart + 60s, 2min);
  EXPECT_TRUE(list.removeExpired(kStart + 65s).empty());
  EXPECT_EQ(list.removeExpired(kStart + 66s).size(), 1u);
}

TEST_F(FleetRegistryTest, PresenceUnderAnotherSubjectIsIgnoredAndCounted) {
  EXPECT_FALSE(list.handleHeartbeat(presenceSubject("b"), presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.handleHeartbeat("naiad.results.a", presenceOf("a").payload(), kStart));
  EXPECT_FALSE(list.handleHeartbeat(presenceSubject("a"), "{}", kStart));
  EXPECT_EQ(list.size(), 0u);
  EXPECT_EQ(list.counters().wrong_subject, 2u);
  EXPECT_EQ(list.counters().unreadable, 1u);
}

TEST_F(FleetRegistryTest, ServerFloodDoesNotEvictAListedServer) {
  handleHeartbeat(list, presenceOf("honest"));
  for (std::size_t i = 0; i < 2 * FleetRegistry::kMaxServers; ++i)
    handleHeartbeat(list, presenceOf("x" + std::to_string(i)));
  EXPECT_EQ(list.size(), FleetRegistry::kMaxServers);
  EXPECT_EQ(list.counters().over_limit, FleetRegistry::kMaxServers + 1);
  handleHeartbeat(list, presenceOf("honest", 7));
  EXPECT_EQ(list.servers().front().players, 7u);
}

TEST_F(FleetRegistryTest, ChoosesFullestUncrowdedServerElseTheEmptiest) {
  handleHeartbeat(list, presenceOf("a", 3));
  handleHeartbeat(list, presenceOf("b", 9));
  handleHeartbeat(list, presenceOf("c", 14));
  EXPECT_EQ(chosen(list), "b") << "the fullest that is calm";
  handleHeartbeat(list, presenceOf("a", 12));
  handleHeartbeat(list, presenceOf("b", 13));
  EXPECT_EQ(chosen(list), "a") << "none is calm";
}

TEST_F(FleetRegistryTest, ChosenSlotIsReservedUntilTheThirdReport) {
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

TEST_F(FleetRegistryTest, PlayersAreSentOnlyWhereTheyCanPlay) {
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
    FleetRegistry spoilt;
    Presence presence = presenceOf("a");
    handleHeartbeat(spoilt, presence);
    ASSERT_EQ(chosen(spoilt, {"tron", 4}), "a");
    one.spoil(presence);
    handleHeartbeat(spoilt, presence);
    handleHeartbeat(spoilt, presence);
    EXPECT_EQ(chosen(spoilt, {"tron", 4}), "") << one.why;
  }
  handleHeartbeat(list, presenceOf("a"));
  EXPECT_EQ(chosen(list, {"tron", 4, "a"}), "") << "back to where they come from";
}

FleetRegistry::PlayerRequest wishFor(const std::string& game, const std::string& room = "") {
  return {game, 4, "", room};
}

TEST_F(FleetRegistryTest, ChoosesARoomOfTheGameWithFreeSlots) {
  Presence server = presenceOf("a", 3, 32);
  server.game = "lobby";
  server.rooms = {
      {"hall", "lobby", 0, 32}, {"duel", "tron", 2, 2}, {"big", "tron", 1, 8}, {"arcade", "maze", 0, 2}};
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

TEST_F(FleetRegistryTest, ChosenRoomSlotIsReservedUntilTheThirdReport) {
  Presence server = presenceOf("a", 0, 32);
  server.rooms = {{"hall", "lobby", 0, 32}, {"one", "tron", 0, 1}, {"two", "tron", 0, 1}};
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

TEST_F(FleetRegistryTest, AFullServerSendsToNoneOfItsRooms) {
  Presence server = presenceOf("a", 4, 4);
  server.rooms = {{"hall", "lobby", 0, 32}};
  handleHeartbeat(list, server);
  EXPECT_EQ(chosen(list), "");
}

TEST_F(FleetRegistryTest, NoServerGetsMorePlayersThanItHasSlots) {
  SplitMix64 random(3);
  std::map<std::string, std::uint32_t> sent;
  for (int i = 0; i < 200; ++i)
    handleHeartbeat(list, presenceOf("s" + std::to_string(i), 0, random.next() % 8));
  for (int i = 0; i < 2000; ++i) ++sent[chosen(list)];
  for (const Presence& one : list.servers()) EXPECT_LE(sent[one.id], one.max_players) << one.id;
  EXPECT_GT(sent[""], 0u) << "all are full in the end";
}

/// Records published messages, delivers messages of the test, and is connected or not, as the test chooses.
class FakeBus : public Bus {
 public:
  void publish(BusMessage message) override { published.push_back(std::move(message)); }
  bool isConnected() const override { return connected; }
  std::vector<BusMessage> popMessages() override { return std::exchange(heard, {}); }
  void finish(std::chrono::milliseconds /*patience*/) override {}
  BusCounters counters() const override { return {.lost = lost}; }
  std::string popLogMessage() override { return std::exchange(news, ""); }

  std::vector<BusMessage> published;
  std::vector<BusMessage> heard;
  std::string news;
  bool connected = true;
  std::uint64_t lost = 0;
};

class FleetMonitorTest : public testing::Test {
 protected:
  void hear(const std::string& id) { bus.heard.push_back({presenceSubject(id), presenceOf(id).payload()}); }
  /// Updates once a second up to this time.
  void update(std::chrono::seconds at) {
    for (now = std::min(now + 1s, at); now < at; now += 1s) watch.update(FleetMonitor::Time{} + now);
    watch.update(FleetMonitor::Time{} + now);
  }

  std::chrono::seconds now{0};
  std::vector<std::string> lines;
  FakeBus* p_bus = new FakeBus();
  FakeBus& bus = *p_bus;
  FleetMonitor watch{std::unique_ptr<Bus>(p_bus), [this](const std::string& line) { lines.push_back(line); }};
};

TEST_F(FleetMonitorTest, SaysWhichServersComeAndGo) {
  bus.news = "the bus is connected";
  hear("a");
  update(0s);
  hear("a");
  update(2s);
  update(8s);
  EXPECT_EQ(lines,
            (std::vector<std::string>{"the bus is connected", "a joined the fleet", "a left the fleet"}));
}

TEST_F(FleetMonitorTest, WithoutABusTheListStaysForTenMinutes) {
  hear("a");
  update(1s);
  bus.connected = false;
  for (auto at = 2s; at < 600s; at += 1s) update(at);
  EXPECT_EQ(watch.servers().size(), 1u);
  for (auto at = 600s; at < 610s; at += 1s) update(at);
  EXPECT_EQ(watch.servers().size(), 0u);
}

TEST_F(FleetMonitorTest, ServersGetAFullTimeoutAfterABusOutage) {
  hear("a");
  hear("b");
  update(1s);
  bus.connected = false;
  for (auto at = 2s; at < 60s; at += 1s) update(at);
  bus.connected = true;
  update(60s);
  hear("a");
  update(64s);
  EXPECT_EQ(watch.servers().size(), 2u);
  update(65s);
  EXPECT_EQ(watch.servers().size(), 1u) << "b was not heard";
}

TEST_F(FleetMonitorTest, BusThatLosesMessagesExcusesSilenceForThreeMinutes) {
  for (const auto& [begin, loss_interval] : {std::pair(0s, 1s), std::pair(1000s, 5s)}) {
    hear("silent");
    hear("honest");
    now = begin;
    update(begin);
    for (auto at = 1s; at < 180s; at += 1s) {
      if (at % loss_interval == 0s) ++bus.lost;
      if (at == 100s) hear("honest");
      update(begin + at);
      ASSERT_EQ(watch.servers().size(), 2u) << at.count();
    }
    for (auto at = 180s; at < 190s; at += 1s) {
      ++bus.lost;
      update(begin + at);
    }
    EXPECT_EQ(watch.servers().size(), 1u) << "silent for three minutes";
    for (auto at = 190s; at < 196s; at += 1s) update(begin + at);
    EXPECT_EQ(watch.servers().size(), 0u) << "nothing is lost any more";
  }
}

TEST_F(FleetMonitorTest, PauseOfTheMachineRemovesNoServer) {
  hear("a");
  hear("b");
  update(1s);
  now = 100s;
  update(101s);
  EXPECT_EQ(watch.servers().size(), 2u);
  hear("a");
  update(106s);
  EXPECT_EQ(watch.servers().size(), 2u);
  update(107s);
  EXPECT_EQ(watch.servers().size(), 1u) << "b was not heard";
}

TEST_F(FleetMonitorTest, ServerFloodDoesNotFillTheLog) {
  for (int i = 0; i < 1000; ++i) hear("x" + std::to_string(i));
  update(0s);
  EXPECT_EQ(lines.size(), 100u);
  hear("y");
  update(1s);
  EXPECT_EQ(lines.at(100), "900 more servers joined or left");
  EXPECT_EQ(lines.at(101), "y joined the fleet");
}

}  // namespace
}  // namespace naiad
