#include <gtest/gtest.h>

#include "host/settings/MetricsAddress.h"

namespace naiad {
namespace {

TEST(MetricsAddress, IsANumericAddressAndAPort) {
  const auto four = MetricsAddress::parse("127.0.0.1:9100");
  ASSERT_TRUE(four);
  EXPECT_EQ(four->address, "127.0.0.1");
  EXPECT_EQ(four->port, 9100);
  EXPECT_EQ(four->hostText(), "127.0.0.1");
  const auto six = MetricsAddress::parse("[::1]:0");
  ASSERT_TRUE(six);
  EXPECT_EQ(six->address, "::1");
  EXPECT_EQ(six->port, 0);
  EXPECT_EQ(six->hostText(), "[::1]");
}

TEST(MetricsAddress, RejectsInvalidAddresses) {
  for (const char* text :
       {"", "9100", ":9100", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:1x",
        "::1:9100", "[::1]", "[127.0.0.1]:1", "localhost:9100", "[]:1", "127.0.0.1:9100 ", "[::1]9100"}) {
    EXPECT_FALSE(MetricsAddress::parse(text)) << text;
  }
}

TEST(MetricsAddress, TellsPrivateAddressesFromPublicOnes) {
  for (const char* text :
       {"127.0.0.1:1", "127.255.0.9:1", "10.1.2.3:1", "172.16.0.1:1", "172.31.255.255:1", "192.168.7.7:1",
        "169.254.0.1:1", "[::1]:1", "[fd00::1]:1", "[fe80::1]:1", "[::ffff:10.0.0.1]:1"}) {
    const auto address = MetricsAddress::parse(text);
    ASSERT_TRUE(address) << text;
    EXPECT_TRUE(address->is_private) << text;
  }
  for (const char* text :
       {"0.0.0.0:1", "[::]:1", "8.8.8.8:1", "172.15.255.255:1", "172.32.0.1:1", "192.169.0.1:1", "11.0.0.1:1",
        "128.0.0.1:1", "[2001:db8::1]:1", "[fec0::1]:1", "[::ffff:8.8.8.8]:1"}) {
    const auto address = MetricsAddress::parse(text);
    ASSERT_TRUE(address) << text;
    EXPECT_FALSE(address->is_private) << text;
  }
}

TEST(MetricsHosts, AllowLocalhostNumericAddressesAndConfiguredNames) {
  const auto hosts = MetricsHosts::parse("game.internal,Node-7");
  ASSERT_TRUE(hosts);
  for (const char* host : {"localhost", "LOCALHOST:9100", "127.0.0.1", "127.0.0.1:1", "[::1]", "[::1]:9100",
                           "10.0.0.9:9100", "game.internal", "Game.Internal:80", "node-7"}) {
    EXPECT_TRUE(hosts->allows(host)) << host;
  }
  for (const char* host :
       {"", ":", "evil.example", "evil.example:9100", "localhost.evil.example", "localhost:x",
        "localhost:99999", "game", "127.0.0.1.evil.example", "user@localhost", "localhost "}) {
    EXPECT_FALSE(hosts->allows(host)) << host;
  }
}

TEST(MetricsHosts, RejectInvalidNames) {
  EXPECT_TRUE(MetricsHosts::parse(""));
  for (const char* names : {",", "a,,b", "a b", "a:80", "http://a", "-a", "a,-b"}) {
    EXPECT_FALSE(MetricsHosts::parse(names)) << names;
  }
}

}  // namespace
}  // namespace naiad
