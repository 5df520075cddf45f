#include <gtest/gtest.h>

#include "LinkPair.h"
#include "shared/net/datagram/LinkPing.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Millis = LinkPing::Millis;

TEST(LinkPing, MeasuresRoundTripWithoutServerDelay) {
  LinkPair pair;
  pair.settle(pair.home);
  EXPECT_FALSE(pair.client.popRoundTrip());
  const std::size_t before = pair.fromClient("key").size();
  pair.client.ping();
  const std::string ping = pair.fromClient("key");
  EXPECT_EQ(ping.size(), before + 1);
  EXPECT_EQ(pair.fromClient("key").size(), before) << "once";
  pair.now += 40ms;
  EXPECT_EQ(pair.toServer(ping), "key");
  pair.now += 33ms;  // time for which the server waits for its tick
  const std::string echo = pair.fromServer("world");
  EXPECT_EQ(pair.fromServer("world").size(), echo.size() - 2) << "once";
  pair.now += 60ms;
  EXPECT_EQ(pair.toClient(echo), "world");
  EXPECT_EQ(pair.client.popRoundTrip(), Millis(100));
  EXPECT_FALSE(pair.client.popRoundTrip());
}

TEST(LinkPing, LateOrLongHeldPingsAreIgnored) {
  LinkPair pair;
  pair.settle(pair.home);
  pair.client.ping();
  const std::string first = pair.fromClient("");
  pair.toServer(first);
  const std::string late = pair.fromServer("");
  pair.client.ping();
  const std::string second = pair.fromClient("");
  pair.toClient(late);
  EXPECT_FALSE(pair.client.popRoundTrip()) << "of the ping before";
  pair.toServer(second);
  pair.now += 256ms;
  pair.toClient(pair.fromServer("held too long"));
  EXPECT_FALSE(pair.client.popRoundTrip());
  pair.client.ping();
  pair.toServer(pair.fromClient(""));
  pair.now += 255ms;
  pair.toClient(pair.fromServer(""));
  EXPECT_EQ(pair.client.popRoundTrip(), Millis(0));
}

TEST(LinkPing, HoldTimeAboveTheRoundTripGivesZero) {
  LinkPing ping;
  const LinkPing::Time now{1h};
  ping.request();
  const std::uint8_t token = ping.onSent(now);
  ping.onEcho({static_cast<std::uint8_t>(token + 1), 0}, now + 9ms);
  EXPECT_FALSE(ping.popRoundTrip());
  ping.onEcho({token, 200}, now + 10ms);
  EXPECT_EQ(ping.popRoundTrip(), Millis(0));
  ping.onEcho({token, 0}, now + 20ms);
  EXPECT_FALSE(ping.popRoundTrip()) << "a second answer";
}

TEST(LinkPing, WaitsForAPacketWithFreeSpace) {
  LinkPair pair;
  pair.toServer(pair.fromClient("here"));
  pair.toClient(pair.fromServer("who?"));  // an answer of 8 bytes is now pending
  pair.client.ping();
  const std::string full(pair.client.maxPayload(), 'x');
  EXPECT_EQ(pair.toServer(pair.fromClient(full)), full);
  const std::string ping = pair.fromClient(std::string(pair.client.maxPayload(), 'y'));
  EXPECT_LE(ping.size(), kMaxDatagram);
  pair.toServer(ping);
  pair.toClient(pair.fromServer(""));
  EXPECT_TRUE(pair.client.popRoundTrip());
}

TEST(LinkPing, PingDoesNotRaiseAnUnprovenAddressesLimit) {
  LinkPair pair;
  pair.client.ping();
  const std::string ping = pair.fromClient("");
  pair.toServer(ping);
  std::size_t sent = 0;
  while (const auto packet = pair.seal(pair.server, "")) sent += packet->bytes.size();
  EXPECT_LE(sent, 3 * ping.size());
}

}  // namespace
}  // namespace naiad::test
