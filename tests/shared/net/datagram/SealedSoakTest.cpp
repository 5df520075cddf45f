// Sockets, DatagramDemux, links, roaming, new keys and forgers together, over a bad network in virtual time.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "LinkPair.h"
#include "shared/net/datagram/DatagramDemux.h"
#include "tests/support/net/VirtualNetwork.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

const Endpoint kServer = *makeEndpoint("10.0.0.1", 9876);

SealedLink::Time timeOf(const VirtualClock& clock) {
  return SealedLink::Time(1h) + clock.now();
}

/// Both ends of a session. Each sends a numbered message per tick and checks that none arrives twice.
struct Player {
  Player(VirtualNetwork& network, VirtualClock& virtual_clock, DatagramDemux& gate,
         DatagramSocket& server_socket, std::uint64_t number)
      : clock(virtual_clock),
        random(number),
        socket(network.open(*makeEndpoint("10.1.0." + std::to_string(number), 0))),
        at_server(server_socket),
        client({.role = SealedLink::Role::kClient, .id = {number}, .random = {}, .limits = {}}),
        server({.role = SealedLink::Role::kServer,
                .id = {number},
                .random = [this] { return random.next(); },
                .limits = {}}) {
    client.setServerPath({.local = {}, .remote = kServer});
    startEpoch(0);
    EXPECT_TRUE(gate.add(server, [this](std::string_view payload) { hear(payload, heard_up, "up"); }));
    socket->start([this](const Path& path, std::string_view packet) {
      if (const auto payload = client.open(path, packet, timeOf(clock))) hear(*payload, heard_down, "down");
      if (client.needsToSend(timeOf(clock))) say(client, *socket, "");
    });
  }
  void startEpoch(Epoch number) {
    const DatagramKeys keys =
        knownKeys(number % 2 ? AeadId::kChaCha20Poly1305 : AeadId::kAes128Gcm, client.id(), number);
    client.startEpoch(number, keys, timeOf(clock));
    server.startEpoch(number, keys, timeOf(clock));
    epoch = number;
  }
  void say(SealedLink& link, DatagramSocket& from, const std::string& payload) {
    const auto outgoing = link.seal(payload, timeOf(clock));
    if (!outgoing) return;
    from.send(outgoing->path, outgoing->packet);
    from.flush();
  }
  void tick() {
    say(client, *socket, "up" + std::to_string(said) + std::string(random.below(60), ' '));
    if (server.needsToSend(timeOf(clock))) say(server, at_server, "");
    const std::size_t size = std::min<std::size_t>(server.payloadBudget().value_or(0), random.below(1000));
    std::string down = "down" + std::to_string(said);
    if (down.size() <= size) down.resize(size, ' ');
    say(server, at_server, down);
    ++said;
  }
  void hear(std::string_view payload, std::set<int>& heard, std::string_view prefix) {
    if (payload.empty()) return;
    ASSERT_EQ(payload.substr(0, prefix.size()), prefix);
    EXPECT_TRUE(heard.insert(std::stoi(std::string(payload.substr(prefix.size())))).second) << payload;
  }

  VirtualClock& clock;
  SplitMix64 random;
  std::unique_ptr<DatagramSocket> socket;
  DatagramSocket& at_server;
  SealedLink client;
  SealedLink server;
  Epoch epoch = 0;
  int said = 0;
  std::set<int> heard_up, heard_down;
};

/// Number of bytes seen by the network, to and from each address.
struct Ledger {
  std::map<Endpoint, std::uint64_t> to, from;
  std::deque<std::string> copies;  // newest packets from clients
};

struct World {
  explicit World(const LinkConditions& conditions, int count)
      : network(clock, conditions, 9), socket(network.open(kServer)) {
    socket->start([this](const Path& path, std::string_view packet) {
      ledger.from[path.remote] += packet.size();
      gate.receive(path, packet, timeOf(clock));
    });
    network.setTap([this](const Endpoint& from, const Endpoint& to, std::string_view packet) {
      if (from == kServer) ledger.to[to] += packet.size();
      if (to != kServer) return;
      ledger.copies.emplace_back(packet);
      if (ledger.copies.size() > 300) ledger.copies.pop_front();
    });
    for (int i = 1; i <= count; ++i) {
      players.push_back(
          std::make_unique<Player>(network, clock, gate, *socket, static_cast<std::uint64_t>(i)));
    }
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      for (const auto& player : players) player->tick();
      clock.advanceBy(33ms);
    }
  }

  VirtualClock clock;
  VirtualNetwork network;
  std::unique_ptr<DatagramSocket> socket;
  DatagramDemux gate;
  Ledger ledger;
  std::vector<std::unique_ptr<Player>> players;
};

TEST(SealedSoak, CleanNetworkLosesNothing) {
  World world({.delay = 30ms}, 5);
  world.run(20);  // until every address is validated
  for (const auto& player : world.players) {
    player->heard_up.clear();
    player->heard_down.clear();
  }
  world.run(300);
  world.clock.advanceBy(1s);
  for (const auto& player : world.players) {
    EXPECT_EQ(player->heard_up.size(), 300u);
    EXPECT_EQ(player->heard_down.size(), 300u);
  }
}

TEST(SealedSoak, SurvivesRoamingRekeyingAndForgersOnBadNetwork) {
  World world({.delay = 50ms, .jitter = 40ms, .loss = 0.05, .duplicate = 0.02}, 6);
  SplitMix64 rng(4);
  std::set<Endpoint> victims;
  for (int second = 0; second < 120; ++second) {
    for (const auto& player : world.players) {
      const std::string address =
          "10.2." + std::to_string(second) + "." + std::to_string(player->client.id().value);
      if (rng.below(8) == 0) world.network.rebind(*player->socket, *makeEndpoint(address, 1000));
      if (rng.below(12) == 0) player->startEpoch(player->epoch + 1);
    }
    // Replayed packets, modified ones and random bytes, from many addresses.
    for (int i = 0; i < 300; ++i) {
      std::string packet = world.ledger.copies.empty()
                               ? std::string(40, '\x10')
                               : world.ledger.copies[rng.below(world.ledger.copies.size())];
      if (rng.below(2)) packet[rng.below(packet.size())] ^= static_cast<char>(1 + rng.below(255));
      const Endpoint victim = *makeEndpoint("203.0.113." + std::to_string(rng.below(256)), 53);
      victims.insert(victim);
      world.network.spoof(victim, kServer, packet);
    }
    world.run(30);
  }
  world.clock.advanceBy(1s);
  for (const auto& player : world.players) {
    const auto said = static_cast<double>(player->said);
    EXPECT_GT(static_cast<double>(player->heard_up.size()), 0.85 * said);
    EXPECT_GT(static_cast<double>(player->heard_down.size()), 0.75 * said);
    EXPECT_GT(player->server.counters().path_changes, 5u);
    EXPECT_GT(player->server.counters().paths_validated, 5u);
    EXPECT_GT(player->epoch, 3u);
    EXPECT_EQ(player->server.counters().malformed + player->client.counters().malformed, 0u);
  }
  for (const Endpoint& victim : victims) EXPECT_LE(world.ledger.to[victim], 3 * world.ledger.from[victim]);
}

TEST(SealedSoak, HijackedPacketsAreLimitedAndTheSessionContinues) {
  // An attacker on the path copies packets. The copies arrive first; the session follows them and returns.
  World world({.delay = 50ms}, 1);
  world.run(20);
  const Endpoint victim = *makeEndpoint("203.0.113.9", 53);
  Player& player = *world.players[0];
  const int before = static_cast<int>(player.heard_down.size());
  for (int tick = 0; tick < 600; ++tick) {
    world.run(1);
    if (tick % 10 == 0) world.network.spoof(victim, kServer, world.ledger.copies.back());
  }
  EXPECT_GT(player.server.counters().path_changes, 50u);
  EXPECT_GT(world.ledger.to[victim], 0u);
  EXPECT_LE(world.ledger.to[victim], 3 * world.ledger.from[victim]);
  EXPECT_GT(static_cast<int>(player.heard_down.size()) - before, 400);
  world.clock.advanceBy(1s);
  EXPECT_EQ(player.heard_up.size(), 620u);
}

}  // namespace
}  // namespace naiad::test
