#include <gtest/gtest.h>

#include "client/lan/DiscoveredServers.h"
#include "client/lan/LanBrowser.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

using asio::ip::make_address;

ShortKey keyNumber(unsigned number) {
  ShortKey::Bytes bytes{};
  bytes[0] = static_cast<std::uint8_t>(number);
  bytes[1] = static_cast<std::uint8_t>(number >> 8);
  return ShortKey::ofBytes(bytes);
}

LanAnswer answerOf(unsigned key, const std::string& name = "server") {
  LanAnswer answer;
  answer.protocol = kProtocolVersion;
  answer.port = 9876;
  answer.max_players = 16;
  answer.key = keyNumber(key);
  answer.name = name;
  answer.game = "hello";
  return answer;
}

asio::ip::udp::endpoint at(const std::string& address) {
  return {make_address(address), kLanPort};
}

TEST(DiscoveredServers, UsesAnnouncedPortAndSourceAddress) {
  DiscoveredServers servers;
  EXPECT_TRUE(servers.addAnswer(at("192.168.1.5"), answerOf(1)));
  ASSERT_EQ(servers.size(), 1u);
  EXPECT_EQ(servers.sorted()[0].address.text(), "192.168.1.5:9876");
  EXPECT_EQ(servers.sorted()[0].link(), "naiad://192.168.1.5#" + keyNumber(1).text());
}

TEST(DiscoveredServers, TheSameKeyIsTheSameServer) {
  DiscoveredServers servers;
  servers.addAnswer(at("192.168.1.5"), answerOf(1));
  EXPECT_FALSE(servers.addAnswer(at("192.168.1.5"), answerOf(1))) << "nothing new";
  LanAnswer fuller = answerOf(1);
  fuller.players = 3;
  EXPECT_TRUE(servers.addAnswer(at("192.168.1.5"), fuller));
  ASSERT_EQ(servers.size(), 1u);
  EXPECT_EQ(servers.sorted()[0].players, 3);
}

TEST(DiscoveredServers, KeepsTheBestOfSeveralAddresses) {
  DiscoveredServers servers;
  const auto where = [&servers] { return servers.sorted()[0].address.host; };
  servers.addAnswer(at("127.0.0.1"), answerOf(1));
  servers.addAnswer(at("fe80::5%1"), answerOf(1));
  EXPECT_TRUE(where().starts_with("fe80::5%")) << where();
  EXPECT_EQ(servers.sorted()[0].link(), "") << "no link has a zone";
  servers.addAnswer(at("fd00::5"), answerOf(1));
  EXPECT_EQ(where(), "fd00::5");
  servers.addAnswer(at("192.168.1.5"), answerOf(1));
  EXPECT_EQ(where(), "192.168.1.5");
  for (const char* p_worse : {"fd00::5", "fe80::5%1", "127.0.0.1", "192.168.1.6"})
    EXPECT_FALSE(servers.addAnswer(at(p_worse), answerOf(1))) << p_worse;
  EXPECT_EQ(where(), "192.168.1.5");
  EXPECT_EQ(servers.size(), 1u);
}

TEST(DiscoveredServers, ListLengthIsLimited) {
  DiscoveredServers servers;
  for (unsigned i = 0; i < 1000; ++i) {
    const std::string address = "10.0." + std::to_string(i / 250) + "." + std::to_string(1 + i % 250);
    servers.addAnswer(at(address), answerOf(i));
  }
  EXPECT_EQ(servers.size(), DiscoveredServers::kMax);
  EXPECT_EQ(servers.sorted().size(), DiscoveredServers::kMax);
}

TEST(DiscoveredServers, OneAddressCannotFillTheList) {
  DiscoveredServers servers;
  for (unsigned i = 0; i < 1000; ++i) servers.addAnswer(at("10.0.0.66"), answerOf(i));
  EXPECT_EQ(servers.size(), DiscoveredServers::kMaxPerAddress);
  EXPECT_TRUE(servers.addAnswer(at("10.0.0.7"), answerOf(1001, "honest")));
}

TEST(DiscoveredServers, AreSortedByName) {
  DiscoveredServers servers;
  servers.addAnswer(at("10.0.0.1"), answerOf(1, "b"));
  servers.addAnswer(at("10.0.0.2"), answerOf(2, "a"));
  servers.addAnswer(at("10.0.0.3"), answerOf(3, "c"));
  std::string names;
  for (const DiscoveredServer& server : servers.sorted()) names += server.name;
  EXPECT_EQ(names, "abc");
}

// ---- packets that are accepted as answers -----------------------------------------------------------------

LanNetwork own(unsigned interface, const std::string& address, unsigned prefix) {
  const auto parsed = make_address(address);
  return {interface, "if", parsed, prefix, parsed.is_loopback(), true};
}

bool isAccepted(const std::string& source, unsigned interface, int hops = 255) {
  LanPacket packet;
  packet.source = at(source);
  packet.interface = interface;
  packet.hop_limit = hops;
  return isFromLink(packet, {own(1, "127.0.0.1", 8), own(2, "192.168.1.20", 24), own(2, "fe80::20", 64)});
}

TEST(LanBrowser, AcceptsAnswersOnlyFromTheQueriedLink) {
  EXPECT_TRUE(isAccepted("192.168.1.5", 2));
  EXPECT_TRUE(isAccepted("fe80::5%2", 2));
  EXPECT_TRUE(isAccepted("127.0.0.1", 1));
  EXPECT_TRUE(isAccepted("192.168.1.20", 1)) << "this machine itself";
  EXPECT_FALSE(isAccepted("192.168.1.21", 1)) << "another one, by loopback";
  EXPECT_FALSE(isAccepted("192.168.1.5", 3));
  EXPECT_FALSE(isAccepted("192.168.2.5", 2));
  EXPECT_FALSE(isAccepted("127.0.0.1", 2));
  EXPECT_FALSE(isAccepted("203.0.113.5", 2));
}

TEST(LanBrowser, RejectsAnswersThatPassedARouter) {
  for (const int hops : {0, 1, 64, 254}) EXPECT_FALSE(isAccepted("192.168.1.5", 2, hops)) << hops;
}

}  // namespace
}  // namespace naiad
