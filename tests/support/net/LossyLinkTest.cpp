#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"
#include "shared/values/SplitMix64.h"
#include "tests/shared/net/Recorder.h"
#include "tests/support/net/LossyLink.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Time = VirtualClock::Time;

struct StreamBench {
  explicit StreamBench(const LinkConditions& conditions, std::uint64_t seed = 1)
      : link(clock, conditions, seed),
        client(link.takeEnd(LinkEnd::kClient)),
        server(link.takeEnd(LinkEnd::kServer)) {
    client->setReceiveLimit(kMaxFramePayload);
    server->setReceiveLimit(kMaxFramePayload);
    auto recording = at_server.callbacks();
    server->start({[this, record = recording.on_frame](std::string_view frame) {
                     record(frame);
                     times.push_back(clock.now());
                   },
                   recording.on_closed});
    client->start(at_client.callbacks());
  }

  VirtualClock clock;
  Recorder at_client;
  Recorder at_server;
  std::vector<Time> times;  // when the server received each frame
  VirtualStreamLink link;
  std::unique_ptr<ReliableChannel> client;
  std::unique_ptr<ReliableChannel> server;
};

/// Returns a frame that takes this many bytes on the line.
std::string frameOnLine(std::size_t bytes) {
  return std::string(bytes - kFrameHeaderSize, 'x');
}

TEST(VirtualStreamLink, AnythingSentArrivesOnceAndInOrder) {
  SplitMix64 rng(5);
  for (int round = 0; round < 100; ++round) {
    StreamBench bench({.delay = Time(rng.below(100'000)),
                       .jitter = Time(rng.below(100'000)),
                       .loss = rng.unit() * 0.3,
                       .rate = rng.below(2) * (10'000 + rng.below(100'000)),
                       .window = 1 + rng.below(30'000)},
                      rng.next());
    std::vector<std::string> sent;
    for (int i = 0; i < 100; ++i) {
      sent.push_back(std::to_string(i) + std::string(rng.below(3000), 'x'));
      bench.client->send(sent.back());
      bench.clock.advanceBy(Time(rng.below(30'000)));
    }
    bench.clock.advanceBy(1h);
    ASSERT_EQ(bench.at_server.frames, sent) << "round " << round;
    ASSERT_EQ(bench.client->unsentBytes(), 0u);
  }
}

TEST(VirtualStreamLink, RetransmissionWaitsTwoRoundTripsAndBacksOff) {
  StreamBench bench({.delay = 100ms, .loss = 1});
  bench.client->send("lost twice");  // at 0, at 400 ms, then at 1200 ms
  bench.clock.advanceTo(500ms);
  bench.link.setConditions(LinkEnd::kClient, {.delay = 100ms});
  bench.clock.advanceTo(5s);
  EXPECT_EQ(bench.times, std::vector<Time>{1300ms});
}

TEST(VirtualStreamLink, RateSpacesFramesOutAndShowsAsUnsentBytes) {
  StreamBench bench({.delay = 5ms, .rate = 10'000});
  for (int i = 0; i < 10; ++i) bench.client->send(frameOnLine(1000));
  EXPECT_EQ(bench.client->unsentBytes(), 10'000u);
  bench.clock.advanceTo(499ms);
  EXPECT_EQ(bench.client->unsentBytes(), 6000u);
  bench.clock.advanceTo(500ms);
  EXPECT_EQ(bench.client->unsentBytes(), 5000u);
  bench.clock.advanceTo(10s);
  EXPECT_EQ(bench.client->unsentBytes(), 0u);
  ASSERT_EQ(bench.times.size(), 10u);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bench.times[i], (i + 1) * 100ms + 5ms);
}

TEST(VirtualStreamLink, WindowLimitsBytesInFlight) {
  StreamBench bench({.delay = 50ms, .window = 2000});
  for (int i = 0; i < 6; ++i) bench.client->send(frameOnLine(1000));
  EXPECT_EQ(bench.client->unsentBytes(), 4000u);
  bench.clock.advanceTo(1s);
  EXPECT_EQ(bench.times, (std::vector<Time>{50ms, 50ms, 150ms, 150ms, 250ms, 250ms}));
}

TEST(VirtualStreamLink, OutageShowsAsUnsentBytesAndThenOverflows) {
  StreamBench bench({.loss = 1});
  bool grew = false;
  for (int i = 0; i < 30 && !bench.at_client.closed; ++i) {
    bench.client->send(std::string(50'000, 'x'));
    EXPECT_FALSE(bench.at_client.closed);
    grew = grew || bench.client->unsentBytes() > 900'000;
    bench.clock.advanceBy(33ms);
  }
  EXPECT_TRUE(grew);
  EXPECT_EQ(bench.at_client.closed, CloseReason::kOverflow);
  bench.link.setConditions(LinkEnd::kClient, {});
  bench.clock.advanceBy(1min);
  EXPECT_EQ(bench.at_server.closed, CloseReason::kError);
}

TEST(VirtualStreamLink, CloseFlushesAndNotifiesBothEnds) {
  StreamBench bench({.delay = 50ms, .rate = 10'000});
  for (int i = 0; i < 5; ++i) bench.client->send(frameOnLine(1000));
  bench.client->close();
  bench.client->send("too late");
  EXPECT_FALSE(bench.at_client.closed);
  bench.clock.advanceTo(549ms);
  EXPECT_FALSE(bench.at_server.closed);
  bench.clock.advanceTo(550ms);
  EXPECT_EQ(bench.at_server.frames.size(), 5u);
  EXPECT_EQ(bench.at_server.closed, CloseReason::kPeer);
  EXPECT_FALSE(bench.at_client.closed);
  bench.clock.advanceTo(600ms);
  EXPECT_EQ(bench.at_client.closed, CloseReason::kLocal);
  bench.clock.advanceBy(1min);
  EXPECT_EQ(bench.at_client.closings + bench.at_server.closings, 2);
}

TEST(VirtualStreamLink, CloseGivesUpAfterASecond) {
  StreamBench bench({.rate = 1000});
  for (int i = 0; i < 5; ++i) bench.client->send(frameOnLine(1000));
  bench.client->close();
  bench.clock.advanceTo(999ms);
  EXPECT_FALSE(bench.at_client.closed);
  bench.clock.advanceTo(1s);
  EXPECT_EQ(bench.at_client.closed, CloseReason::kLocal);
  EXPECT_EQ(bench.client->unsentBytes(), 0u);
  bench.clock.advanceBy(1min);
  EXPECT_EQ(bench.at_server.closed, CloseReason::kError);
  EXPECT_LE(bench.at_server.frames.size(), 2u);
}

TEST(VirtualStreamLink, BrokenConnectionEndsBothWithAnError) {
  StreamBench bench({.delay = 50ms});
  bench.client->send("never");
  bench.link.breakConnection();
  EXPECT_FALSE(bench.at_client.closed);
  bench.clock.advanceBy(1min);
  EXPECT_EQ(bench.at_client.closed, CloseReason::kError);
  EXPECT_EQ(bench.at_server.closed, CloseReason::kError);
  EXPECT_TRUE(bench.at_server.frames.empty());
}

TEST(VirtualStreamLink, EndMayBeDestroyedInItsCallbacks) {
  VirtualClock clock;
  VirtualStreamLink link(clock, {}, 1);
  auto client = link.takeEnd(LinkEnd::kClient);
  auto server = link.takeEnd(LinkEnd::kServer);
  int calls = 0;
  server->start({[&, marker = std::string(100, 'm')](std::string_view) {
                   server.reset();
                   calls += marker.size() == 100;
                 },
                 [](CloseReason) { FAIL() << "callback after destruction"; }});
  client->start({nullptr, [&, marker = std::string(100, 'm')](CloseReason) {
                   client.reset();
                   calls += marker.size() == 100;
                 }});
  client->send("one");
  client->send("two");
  clock.advanceBy(1s);
  EXPECT_EQ(calls, 2);
}

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
}  // namespace naiad::test
