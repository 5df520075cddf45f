#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "LinkPair.h"
#include "shared/net/datagram/DatagramDemux.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

/// A session of the DatagramDemux and its client.
struct Guest : LinkPair {
  Guest(DatagramDemux& door, std::uint64_t number) : LinkPair(AeadId::kAes128Gcm, {}, {number}), gate(door) {
    home = pathFrom("198.51.100." + std::to_string(number % 200));
    EXPECT_TRUE(gate.add(server, [this](std::string_view payload) { heard.emplace_back(payload); }));
  }
  void say(std::string_view payload, const Path& path) { gate.receive(path, fromClient(payload), now); }
  void say(std::string_view payload) { say(payload, home); }
  void settle() {
    say("here");
    toClient(fromServer("who?"));
    say("me");
    ASSERT_TRUE(server.isValidated(home));
    heard.clear();
  }

  DatagramDemux& gate;
  std::vector<std::string> heard;
};

using Guests = std::vector<std::unique_ptr<Guest>>;

Guests twentyGuests(DatagramDemux& gate) {
  Guests guests;
  for (std::uint64_t i = 1; i <= 20; ++i) guests.push_back(std::make_unique<Guest>(gate, i));
  return guests;
}

/// Returns how many forged packets reached the cryptography of a session.
std::uint64_t forgedForAll(const Guests& guests) {
  std::uint64_t sum = 0;
  for (const auto& guest : guests) sum += guest->server.counters().forged;
  return sum;
}

std::string forgedFor(ConnectionId id, SplitMix64& rng) {
  std::string packet(40, '\0');
  for (char& byte : packet) byte = static_cast<char>(rng.next());
  writeSealedPrefix(SealDirection::kClientToServer, 0, id, packet.data());
  packet[9] = static_cast<char>(rng.next());
  packet[10] = 0x20;  // a sequence number that the replay window accepts
  return packet;
}

Path anywhere(SplitMix64& rng) {
  Path path = pathFrom("203.0.113.1", static_cast<std::uint16_t>(rng.next()));
  for (std::size_t i = 12; i < 16; ++i) path.remote.address[i] = static_cast<std::uint8_t>(rng.next());
  return path;
}

struct DatagramDemuxTest : testing::Test {
  void settleBoth() {
    ann.settle();
    ben.settle();
  }

  DatagramDemux gate;
  Guest ann{gate, 1}, ben{gate, 2};
  SplitMix64 rng{3};
};

TEST_F(DatagramDemuxTest, IdsAreUniqueAndReusableAfterRemoval) {
  SealedLink other({.role = SealedLink::Role::kServer, .id = {1}, .random = [] { return 0; }, .limits = {}});
  EXPECT_FALSE(gate.add(other, [](std::string_view) { FAIL(); }));
  ann.say("x");
  gate.remove({1});
  ann.say("y");
  EXPECT_EQ(ann.heard, std::vector<std::string>{"x"});
  EXPECT_EQ(gate.counters().unknown_id, 1u);
  EXPECT_TRUE(gate.add(other, [](std::string_view) {}));
}

TEST_F(DatagramDemuxTest, RefusalsAreCountedByReason) {
  const std::string packet = ann.fromClient("x");
  const auto receive = [&](const std::string& bytes) { gate.receive(ann.home, bytes, ann.now); };
  receive("");
  receive(packet.substr(0, 27));
  receive(packet + std::string(1200, 'x'));
  receive('\x20' + packet.substr(1));
  receive(packet.substr(0, 3) + "other id" + packet.substr(11));
  receive(packet);
  receive(packet);
  std::string forged = ann.fromClient("y");
  forged.back() = static_cast<char>(forged.back() ^ 1);
  receive(forged);
  const DatagramDemuxCounters& counted = gate.counters();
  EXPECT_EQ(counted.too_short, 2u);
  EXPECT_EQ(counted.too_long, 1u);
  EXPECT_EQ(counted.bad_kind, 1u);
  EXPECT_EQ(counted.unknown_id, 1u);
  EXPECT_EQ(counted.delivered, 1u);
  EXPECT_EQ(counted.refused, 2u);
  EXPECT_EQ(ann.server.counters().replayed, 1u);
  EXPECT_EQ(ann.server.counters().forged, 1u);
}

TEST_F(DatagramDemuxTest, HandlerMayRemoveItsSession) {
  int calls = 0;
  SealedLink link(
      {.role = SealedLink::Role::kServer, .id = kSession, .random = [] { return 0; }, .limits = {}});
  LinkPair pair;
  link.startEpoch(0, pair.keys(0), pair.now);
  gate.add(link, [&, marker = std::string(100, 'm')](std::string_view payload) {
    gate.remove(kSession);
    calls += marker.size() == 100 && payload == "x";
  });
  gate.receive(pair.home, pair.fromClient("x"), pair.now);
  gate.receive(pair.home, pair.fromClient("x"), pair.now);
  EXPECT_EQ(calls, 1);
}

TEST_F(DatagramDemuxTest, ForgersWithoutAnIdReachNoCryptography) {
  for (int i = 0; i < 100'000; ++i) gate.receive(anywhere(rng), forgedFor({rng.next()}, rng), ann.now);
  EXPECT_EQ(gate.counters().unknown_id, 100'000u);
  ann.say("a stranger is heard at once");
  EXPECT_EQ(ann.heard.size(), 1u);
}

TEST_F(DatagramDemuxTest, ForgedFloodLeavesAProvenSessionUnharmed) {
  settleBoth();
  int said = 0;
  for (int tick = 0; tick < 300;
       ++tick) {  // 10 s, 300,000 forged packets from many addresses, with the id of ann's session
    for (int i = 0; i < 1000; ++i) gate.receive(anywhere(rng), forgedFor({1}, rng), ann.now);
    for (Guest* guest : {&ann, &ben}) {
      guest->now += 33ms;
      guest->say("input");
      guest->say("again");
    }
    said += 2;
  }
  EXPECT_EQ(ann.heard.size(), static_cast<std::size_t>(said));
  EXPECT_EQ(ben.heard.size(), static_cast<std::size_t>(said));
  EXPECT_LT(ann.server.counters().forged, 64 + 32 * 11u);  // only this many of the 300,000 were decrypted
  EXPECT_GT(ann.server.counters().forged, 300u);
  EXPECT_GT(gate.counters().unvalidated_session_flood, 290'000u);
}

TEST_F(DatagramDemuxTest, FloodOnOneSessionDoesNotStopOthersRoaming) {
  settleBoth();
  for (int i = 0; i < 100'000; ++i) gate.receive(anywhere(rng), forgedFor({1}, rng), ann.now);
  ben.say("roamed", pathFrom("203.0.113.77"));
  EXPECT_EQ(ben.heard, std::vector<std::string>{"roamed"});
}

TEST_F(DatagramDemuxTest, FloodFromOnePrefixIsLimitedToIt) {
  DatagramDemuxRates rates;
  rates.prefix = {.per_second = 1, .burst = 50};
  DatagramDemux limited(rates);
  const auto guests = twentyGuests(limited);
  const Path attacker = pathFrom("203.0.113.1");
  for (int i = 0; i < 10'000; ++i) {
    Path path = attacker;
    path.remote.port = static_cast<std::uint16_t>(rng.next());
    limited.receive(path, forgedFor({1 + rng.below(10)}, rng), guests[0]->now);
  }
  EXPECT_EQ(forgedForAll(guests), 50u);
  EXPECT_GT(limited.counters().prefix_flood, 0u);
  for (std::size_t i = 10; i < 20; ++i) {
    guests[i]->say("first");
    EXPECT_EQ(guests[i]->heard.size(), 1u);
  }
}

TEST_F(DatagramDemuxTest, UnprovenAddressesShareOneLimit) {
  DatagramDemuxRates rates;
  rates.strangers = {.per_second = 10, .burst = 100};
  DatagramDemux limited(rates);
  const auto guests = twentyGuests(limited);
  guests[0]->settle();
  for (int i = 0; i < 10'000; ++i)
    limited.receive(anywhere(rng), forgedFor({1 + rng.below(20)}, rng), guests[0]->now);
  EXPECT_EQ(forgedForAll(guests), 98u);  // settle() used two of the rate
  EXPECT_GT(limited.counters().unvalidated_flood, 0u);
  for (int i = 0; i < 100; ++i) guests[0]->say("unharmed");
  EXPECT_EQ(guests[0]->heard.size(), 100u);
}

TEST_F(DatagramDemuxTest, EachSessionHasItsOwnRateLimit) {
  settleBoth();
  for (int i = 0; i < 2000; ++i) ann.say("much");
  EXPECT_EQ(ann.heard.size(), 500u);
  EXPECT_EQ(gate.counters().session_flood, 1500u);
  ben.say("x");
  EXPECT_EQ(ben.heard.size(), 1u);
  ann.now += 1s;
  for (int i = 0; i < 2000; ++i) ann.say("much");
  EXPECT_EQ(ann.heard.size(), 750u);
}

TEST_F(DatagramDemuxTest, ReplaysConsumeNoRateLimit) {
  ann.settle();
  const std::string packet = ann.fromClient("once");
  for (int i = 0; i < 10'000; ++i) gate.receive(ann.home, packet, ann.now);
  ann.say("still heard");
  EXPECT_EQ(ann.heard, (std::vector<std::string>{"once", "still heard"}));
  EXPECT_EQ(ann.server.counters().replayed, 9999u);
}

}  // namespace
}  // namespace naiad::test
