#include <gtest/gtest.h>

#include "LinkPair.h"
#include "shared/net/datagram/LinkPing.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using LinkPingTest = LinkFixture;
using Millis = LinkPing::Millis;

TEST_F(LinkPingTest, MeasuresRoundTripWithoutServerDelay) {
  settle(home);
  EXPECT_FALSE(client.popRoundTrip());
  const std::size_t before = fromClient("key").size();
  client.ping();
  const std::string ping = fromClient("key");
  EXPECT_EQ(ping.size(), before + 1);
  EXPECT_EQ(fromClient("key").size(), before) << "once";
  now += 40ms;
  EXPECT_EQ(toServer(ping), "key");
  now += 33ms;  // time for which the server waits for its tick
  const std::string echo = fromServer("world");
  EXPECT_EQ(fromServer("world").size(), echo.size() - 2) << "once";
  now += 60ms;
  EXPECT_EQ(toClient(echo), "world");
  EXPECT_EQ(client.popRoundTrip(), Millis(100));
  EXPECT_FALSE(client.popRoundTrip());
}

TEST_F(LinkPingTest, LateOrLongHeldPingsAreIgnored) {
  settle(home);
  client.ping();
  const std::string first = fromClient("");
  toServer(first);
  const std::string late = fromServer("");
  client.ping();
  const std::string second = fromClient("");
  toClient(late);
  EXPECT_FALSE(client.popRoundTrip()) << "of the ping before";
  toServer(second);
  now += 256ms;
  toClient(fromServer("held too long"));
  EXPECT_FALSE(client.popRoundTrip());
  client.ping();
  toServer(fromClient(""));
  now += 255ms;
  toClient(fromServer(""));
  EXPECT_EQ(client.popRoundTrip(), Millis(0));
}

TEST_F(LinkPingTest, HoldTimeAboveTheRoundTripGivesZero) {
  LinkPing ping;
  ping.request();
  const std::uint8_t token = ping.onSent(now);
  ping.onEcho({static_cast<std::uint8_t>(token + 1), 0}, now + 9ms);
  EXPECT_FALSE(ping.popRoundTrip());
  ping.onEcho({token, 200}, now + 10ms);
  EXPECT_EQ(ping.popRoundTrip(), Millis(0));
  ping.onEcho({token, 0}, now + 20ms);
  EXPECT_FALSE(ping.popRoundTrip()) << "a second answer";
}

TEST_F(LinkPingTest, WaitsForAPacketWithFreeSpace) {
  toServer(fromClient("here"));
  toClient(fromServer("who?"));  // an answer of 8 bytes is now pending
  client.ping();
  const std::string full(client.maxPayload(), 'x');
  EXPECT_EQ(toServer(fromClient(full)), full);
  const std::string ping = fromClient(std::string(client.maxPayload(), 'y'));
  EXPECT_LE(ping.size(), kMaxDatagram);
  toServer(ping);
  toClient(fromServer(""));
  EXPECT_TRUE(client.popRoundTrip());
}

TEST_F(LinkPingTest, PingDoesNotRaiseAnUnprovenAddressesLimit) {
  client.ping();
  const std::string ping = fromClient("");
  toServer(ping);
  std::size_t sent = 0;
  while (const auto packet = seal(server, "")) sent += packet->bytes.size();
  EXPECT_LE(sent, 3 * ping.size());
}

}  // namespace
}  // namespace naiad::test
