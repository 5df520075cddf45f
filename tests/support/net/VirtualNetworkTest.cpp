#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shared/values/SplitMix64.h"
#include "tests/support/net/VirtualNetwork.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = VirtualClock::Time;

Endpoint at(const char* address, std::uint16_t port = 9876) {
  return *makeEndpoint(address, port);
}

struct NetworkArrival {
  Time when;
  Path path;
  std::string packet;
  friend bool operator==(const NetworkArrival&, const NetworkArrival&) = default;
};

struct Host {
  Host(VirtualNetwork& network, VirtualClock& clock, const Endpoint& address)
      : socket(network.open(address)) {
    socket->start([this, &clock](const Path& path, std::string_view packet) {
      arrivals.push_back({clock.now(), path, std::string(packet)});
    });
  }
  void send(const Endpoint& to, std::string_view packet) {
    socket->send({.local = {}, .remote = to}, packet);
    socket->flush();
  }

  std::unique_ptr<DatagramSocket> socket;
  std::vector<NetworkArrival> arrivals;
};

struct NetworkBench {
  explicit NetworkBench(const LinkConditions& conditions, std::uint64_t seed = 1)
      : network(clock, conditions, seed),
        server(network, clock, at("10.0.0.1")),
        ann(network, clock, at("10.0.0.2", 0)),
        ben(network, clock, at("10.0.0.3", 0)) {}

  VirtualClock clock;
  VirtualNetwork network;
  Host server, ann, ben;
};

TEST(VirtualNetwork, DeliversByAddressWithBothEndsOfThePath) {
  NetworkBench bench({.delay = 20ms});
  bench.ann.send(at("10.0.0.1"), "to the server");
  bench.clock.advanceBy(1s);
  const Path path{.local = at("10.0.0.1"), .remote = bench.ann.socket->localEndpoint()};
  EXPECT_EQ(bench.server.arrivals, (std::vector<NetworkArrival>{{20ms, path, "to the server"}}));
  EXPECT_TRUE(bench.ben.arrivals.empty());
  bench.server.send(path.remote, "back");
  bench.clock.advanceBy(1s);
  ASSERT_EQ(bench.ann.arrivals.size(), 1u);
  EXPECT_EQ(bench.ann.arrivals[0].path.remote, at("10.0.0.1"));
}

TEST(VirtualNetwork, PacketsToAnAbandonedAddressAreLost) {
  NetworkBench bench({.delay = 20ms});
  const Endpoint old = bench.ann.socket->localEndpoint();
  bench.server.send(old, "under way");
  bench.network.rebind(*bench.ann.socket, at("10.9.9.9", 1234));
  bench.clock.advanceBy(1s);
  bench.server.send(old, "too late");
  bench.ann.send(at("10.0.0.1"), "from elsewhere");
  bench.clock.advanceBy(1s);
  EXPECT_TRUE(bench.ann.arrivals.empty());
  ASSERT_EQ(bench.server.arrivals.size(), 1u);
  EXPECT_EQ(bench.server.arrivals[0].path.remote, at("10.9.9.9", 1234));
  EXPECT_EQ(bench.network.unroutable(), 2u);
  bench.server.send(at("10.9.9.9", 1234), "found");
  bench.clock.advanceBy(1s);
  EXPECT_EQ(bench.ann.arrivals.size(), 1u);
}

TEST(VirtualNetwork, PairsHaveSeparateConditions) {
  NetworkBench bench({.delay = 10ms});
  bench.network.setConditions(*bench.ann.socket, *bench.server.socket, {.delay = 50ms});
  bench.network.setConditions(*bench.server.socket, *bench.ann.socket, {.loss = 1});
  bench.ann.send(at("10.0.0.1"), "slow");
  bench.ben.send(at("10.0.0.1"), "fast");
  bench.server.send(bench.ann.socket->localEndpoint(), "lost");
  bench.clock.advanceBy(1s);
  ASSERT_EQ(bench.server.arrivals.size(), 2u);
  EXPECT_EQ(bench.server.arrivals[0].packet, "fast");
  EXPECT_EQ(bench.server.arrivals[1].when, 50ms);
  EXPECT_EQ(bench.network.counters(*bench.server.socket, *bench.ann.socket).dropped, 1u);
  bench.network.setConditions({});
  bench.server.send(bench.ann.socket->localEndpoint(), "found");
  bench.clock.advanceBy(1s);
  EXPECT_EQ(bench.ann.arrivals.size(), 1u);
}

TEST(VirtualNetwork, SameSeedGivesTheSameAccountedDeliveries) {
  const auto run = [](std::uint64_t seed) {
    NetworkBench bench({.delay = 30ms, .jitter = 40ms, .loss = 0.1, .duplicate = 0.1}, seed);
    for (int i = 0; i < 500; ++i) {
      bench.ann.send(at("10.0.0.1"), "a" + std::to_string(i));
      bench.ben.send(at("10.0.0.1"), "b" + std::to_string(i));
      bench.clock.advanceBy(2ms);
    }
    bench.clock.advanceBy(1s);
    std::uint64_t delivered = 0;
    for (const Host* host : {&bench.ann, &bench.ben}) {
      const LinkCounters counted = bench.network.counters(*host->socket, *bench.server.socket);
      EXPECT_EQ(counted.sent, 500u);
      EXPECT_EQ(counted.sent + counted.duplicated, counted.delivered + counted.dropped);
      EXPECT_GT(counted.dropped, 20u);
      delivered += counted.delivered;
    }
    EXPECT_EQ(delivered, bench.server.arrivals.size());
    return bench.server.arrivals;
  };
  EXPECT_EQ(run(7), run(7));
  EXPECT_NE(run(7), run(8));
}

}  // namespace
}  // namespace naiad
