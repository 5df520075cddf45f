#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "shared/values/SplitMix64.h"
#include "tests/support/net/LossyLink.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = VirtualClock::Time;

struct LinkArrival {
  Time when;
  std::string packet;
};

/// A link with both ends taken. Records what arrives at the server.
struct LinkBench {
  explicit LinkBench(const LinkConditions& conditions, std::uint64_t seed = 1)
      : link(clock, conditions, seed),
        client(link.takeEnd(LinkEnd::kClient)),
        server(link.takeEnd(LinkEnd::kServer)) {
    server->start([this](std::string_view packet) {
      arrivals.push_back({clock.now(), std::string(packet)});
    });
  }
  /// Sends packets "0", "1", …, one each `interval`, and then waits a minute for the last ones.
  void sendMany(int count, Time interval) {
    for (int i = 0; i < count; ++i) {
      client->send(std::to_string(i));
      clock.advanceBy(interval);
    }
    clock.advanceBy(60s);
  }
  const LinkCounters& counters() const { return link.counters(LinkEnd::kClient); }
  std::vector<int> numbers() const {
    std::vector<int> all;
    for (const LinkArrival& arrival : arrivals) all.push_back(std::stoi(arrival.packet));
    return all;
  }

  VirtualClock clock;
  LossyDatagramLink link;
  std::unique_ptr<DatagramChannel> client;
  std::unique_ptr<DatagramChannel> server;
  std::vector<LinkArrival> arrivals;
};

TEST(LossyDatagramLink, LosesTheConfiguredShare) {
  for (const double loss : {0.0, 0.02, 0.3, 1.0}) {
    LinkBench bench({.loss = loss});
    bench.sendMany(20'000, 1us);
    EXPECT_NEAR(static_cast<double>(bench.counters().dropped) / 20'000, loss, 0.012) << loss;
    EXPECT_EQ(bench.counters().delivered, bench.arrivals.size());
    EXPECT_EQ(bench.counters().delivered + bench.counters().dropped, 20'000u);
  }
}

TEST(LossyDatagramLink, DuplicatesTheConfiguredShare) {
  LinkBench bench({.delay = 1ms, .duplicate = 0.1});
  bench.sendMany(20'000, 1us);
  EXPECT_NEAR(static_cast<double>(bench.counters().duplicated) / 20'000, 0.1, 0.01);
  EXPECT_EQ(bench.arrivals.size(), 20'000 + bench.counters().duplicated);
  const auto numbers = bench.numbers();
  EXPECT_EQ(std::set<int>(numbers.begin(), numbers.end()).size(), 20'000u);
}

TEST(LossyDatagramLink, JitterStaysInItsRangeAndReorders) {
  LinkBench bench({.delay = 10ms, .jitter = 20ms});
  bench.sendMany(2000, 1ms);
  Time least = 1h, most{};
  for (const LinkArrival& arrival : bench.arrivals) {
    const Time took = arrival.when - std::stoi(arrival.packet) * 1ms;
    least = std::min(least, took);
    most = std::max(most, took);
  }
  EXPECT_GE(least, 10ms);
  EXPECT_LT(least, 11ms);
  EXPECT_LE(most, 30ms);
  EXPECT_GT(most, 29ms);
  const auto numbers = bench.numbers();
  EXPECT_FALSE(std::is_sorted(numbers.begin(), numbers.end()));
  std::uint64_t late = 0;
  int newest = -1;
  for (const int number : numbers) {
    late += number < newest;
    newest = std::max(newest, number);
  }
  EXPECT_EQ(bench.counters().reordered, late);
}

TEST(LossyDatagramLink, WithoutReorderingJitterKeepsTheOrder) {
  LinkBench bench({.delay = 10ms, .jitter = 20ms, .reorder = false, .duplicate = 0.2});
  bench.sendMany(2000, 1ms);
  const auto numbers = bench.numbers();
  EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
  EXPECT_EQ(bench.counters().reordered, 0u);
}

TEST(LossyDatagramLink, RateSpacesPacketsOut) {
  LinkBench bench({.delay = 5ms, .rate = 10'000});
  for (int i = 0; i < 10; ++i) bench.client->send(std::string(1000, 'x'));
  bench.clock.advanceBy(10s);
  ASSERT_EQ(bench.arrivals.size(), 10u);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bench.arrivals[i].when, (i + 1) * 100ms + 5ms);
}

TEST(LossyDatagramLink, FullQueueDropsPackets) {
  LinkBench bench({.rate = 10'000, .queue = 3000});
  for (int i = 0; i < 10; ++i) bench.client->send(std::to_string(i) + std::string(999, 'x'));
  bench.clock.advanceBy(150ms);  // half of the second is still on the line
  for (int i = 0; i < 2; ++i) bench.client->send("z" + std::string(999, 'x'));
  bench.clock.advanceBy(10s);
  std::string order;
  for (const LinkArrival& arrival : bench.arrivals) order += arrival.packet[0];
  EXPECT_EQ(order, "012z");
  EXPECT_EQ(bench.counters().dropped, 8u);
}

TEST(LossyDatagramLink, EveryPacketIsAccountedFor) {
  SplitMix64 rng(11);
  for (int round = 0; round < 200; ++round) {
    LinkBench bench({.delay = Time(rng.below(50'000)),
                     .jitter = Time(rng.below(50'000)),
                     .reorder = rng.below(2) == 0,
                     .loss = rng.unit(),
                     .duplicate = rng.unit(),
                     .rate = rng.below(3) == 0 ? 0 : 1 + rng.below(20'000),
                     .queue = rng.below(5000)},
                    rng.next());
    for (int i = 0; i < 200; ++i) {
      bench.client->send(std::string(rng.below(1201), 'x'));
      bench.clock.advanceBy(Time(rng.below(20'000)));
    }
    bench.clock.advanceBy(1h * 24);
    const LinkCounters& counted = bench.counters();
    ASSERT_EQ(counted.sent, 200u);
    ASSERT_EQ(counted.sent + counted.duplicated, counted.delivered + counted.dropped) << "round " << round;
    ASSERT_EQ(counted.delivered, bench.arrivals.size());
  }
}

}  // namespace
}  // namespace naiad
