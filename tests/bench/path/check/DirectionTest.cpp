#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bench/path/Monotonic.h"
#include "tests/bench/path/link/Direction.h"

namespace bench::path {
namespace {

constexpr std::uint8_t kTcp = 6;
constexpr std::uint8_t kUdp = 17;

std::vector<std::uint8_t> packet(std::size_t size, std::uint8_t protocol = kTcp) {
  std::vector<std::uint8_t> bytes(size);
  bytes[0] = 0x45;
  bytes[9] = protocol;
  return bytes;
}

/// Returns when all packets that are under way come out.
std::vector<Nanoseconds> deliveries(Direction& direction) {
  std::vector<Nanoseconds> times;
  while (const auto due = direction.next()) {
    EXPECT_TRUE(direction.pop(*due - Nanoseconds(1)).packet.empty());
    times.push_back(direction.pop(*due).due);
  }
  return times;
}

TEST(Direction, DeliversAfterTheDelay) {
  DirectionCounters counters;
  Direction direction({.delay = fromMilliseconds(50)}, counters);
  direction.take(packet(100), fromMilliseconds(7));
  direction.take(packet(200), fromMilliseconds(9));
  EXPECT_EQ(deliveries(direction), (std::vector{fromMilliseconds(57), fromMilliseconds(59)}));
  EXPECT_EQ(counters.bytes, 300u);
  EXPECT_EQ(counters.packets, 2u);
}

TEST(Direction, DeliversPacketsUnchanged) {
  DirectionCounters counters;
  Direction direction({}, counters);
  const auto sent = packet(60);
  direction.take(sent, fromMilliseconds(1));
  EXPECT_EQ(direction.pop(fromMilliseconds(1)).packet, sent);
}

TEST(Direction, RateSpacesPackets) {
  DirectionCounters counters;
  Direction direction({.delay = fromMilliseconds(10), .rate_bit_s = 512'000}, counters);
  for (int i = 0; i < 3; ++i) direction.take(packet(1280), fromMilliseconds(0));
  EXPECT_EQ(deliveries(direction), (std::vector{fromMilliseconds(30), fromMilliseconds(50),
                                                fromMilliseconds(70)}));  // each takes 20 ms on the wire
}

TEST(Direction, FullQueueDropsTheTail) {
  DirectionCounters counters;
  Direction direction({.rate_bit_s = 512'000, .queue_bytes = 64 * 1024}, counters);
  for (int i = 0; i < 100; ++i) direction.take(packet(1024), fromMilliseconds(0));
  EXPECT_EQ(deliveries(direction).size(), 64u);
  EXPECT_EQ(counters.overflowed, 36u);
  direction.take(packet(1024), fromMilliseconds(10'000));  // the queue is empty again
  EXPECT_EQ(deliveries(direction).size(), 1u);
}

TEST(Direction, LosesTheConfiguredShareReproducibly) {
  const auto survivors = [](std::uint64_t seed) {
    DirectionCounters counters;
    Direction direction({.loss = 0.02, .seed = seed}, counters);
    for (int i = 0; i < 50'000; ++i) direction.take(packet(100), fromMilliseconds(i));
    EXPECT_NEAR(static_cast<double>(counters.lost), 1000, 150);
    EXPECT_EQ(counters.bytes, 5'000'000u) << "lost packets were sent, too";
    return deliveries(direction);
  };
  EXPECT_EQ(survivors(1), survivors(1));
  EXPECT_NE(survivors(1), survivors(2));
}

TEST(Direction, JitterKeepsTheOrder) {
  DirectionCounters counters;
  Direction direction({.delay = fromMilliseconds(50), .jitter = fromMilliseconds(20)}, counters);
  for (int i = 0; i < 1000; ++i) direction.take(packet(100), fromMilliseconds(i));
  const auto times = deliveries(direction);
  ASSERT_EQ(times.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Nanoseconds sent = fromMilliseconds(static_cast<double>(i));
    EXPECT_GE(times[i], sent + fromMilliseconds(50));
    EXPECT_LT(times[i], sent + fromMilliseconds(70));
  }
}

TEST(Direction, BlocksOnlyUdp) {
  DirectionCounters counters;
  Direction direction({.block_udp = true}, counters);
  direction.take(packet(100, kUdp), fromMilliseconds(0));
  direction.take(packet(100, kTcp), fromMilliseconds(0));
  EXPECT_EQ(deliveries(direction).size(), 1u);
  EXPECT_EQ(counters.blocked, 1u);
}

TEST(Direction, DropsPacketsThatAreNotIpv4) {
  DirectionCounters counters;
  Direction direction({}, counters);
  auto ipv6 = packet(100);
  ipv6[0] = 0x60;
  direction.take(ipv6, fromMilliseconds(0));
  direction.take(std::vector<std::uint8_t>(3, 0x45), fromMilliseconds(0));
  EXPECT_FALSE(direction.next());
  EXPECT_EQ(counters.packets, 0u);
}

}  // namespace
}  // namespace bench::path
