#include <gtest/gtest.h>

#include <vector>

#include "tests/bench/path/link/Direction.h"

namespace bench::path {
namespace {

// LossyDatagramLinkTest tests loss, rates and queues.

constexpr std::uint8_t kTcp = 6;
constexpr std::uint8_t kUdp = 17;

std::vector<std::uint8_t> packet(std::size_t size, std::uint8_t protocol = kTcp) {
  std::vector<std::uint8_t> bytes(size);
  bytes[0] = 0x45;
  bytes[9] = protocol;
  return bytes;
}

TEST(Direction, DeliversPacketsUnchangedAfterTheDelay) {
  std::atomic<std::uint64_t> bytes{0};
  Direction direction({.delay = std::chrono::milliseconds(50)}, false, 1, bytes);
  direction.take(packet(100), fromMilliseconds(7));
  direction.take(packet(200), fromMilliseconds(9));
  EXPECT_EQ(bytes, 300u);
  for (const auto& [size, due] : {std::pair{100, 57}, {200, 59}}) {
    ASSERT_EQ(direction.next(), fromMilliseconds(due));
    EXPECT_TRUE(direction.pop(*direction.next() - Nanoseconds(1)).packet.empty());
    EXPECT_EQ(direction.pop(*direction.next()).packet, packet(static_cast<std::size_t>(size)));
  }
  EXPECT_FALSE(direction.next());
}

TEST(Direction, CountsLostPackets) {
  std::atomic<std::uint64_t> bytes{0};
  Direction direction({.loss = 1}, false, 1, bytes);
  direction.take(packet(100), fromMilliseconds(0));
  EXPECT_FALSE(direction.next());
  EXPECT_EQ(bytes, 100u);
}

TEST(Direction, BlocksOnlyUdp) {
  std::atomic<std::uint64_t> bytes{0};
  Direction direction({}, true, 1, bytes);
  direction.take(packet(100, kUdp), fromMilliseconds(0));
  EXPECT_FALSE(direction.next());
  direction.take(packet(100, kTcp), fromMilliseconds(0));
  EXPECT_TRUE(direction.next());
}

TEST(Direction, DropsPacketsThatAreNotIpv4) {
  std::atomic<std::uint64_t> bytes{0};
  Direction direction({}, false, 1, bytes);
  auto ipv6 = packet(100);
  ipv6[0] = 0x60;
  direction.take(ipv6, fromMilliseconds(0));
  direction.take(std::vector<std::uint8_t>(3, 0x45), fromMilliseconds(0));
  EXPECT_FALSE(direction.next());
  EXPECT_EQ(bytes, 0u);
}

}  // namespace
}  // namespace bench::path
