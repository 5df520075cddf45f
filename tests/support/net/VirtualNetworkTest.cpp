#include <gtest/gtest.h>

#include <string>
#include <vector>

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
  explicit NetworkBench(const LinkConditions& conditions)
      : network(clock, conditions, 1),
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
  bench.network.setConditions({});
  bench.server.send(bench.ann.socket->localEndpoint(), "found");
  bench.clock.advanceBy(1s);
  EXPECT_EQ(bench.ann.arrivals.size(), 1u);
}

}  // namespace
}  // namespace naiad
