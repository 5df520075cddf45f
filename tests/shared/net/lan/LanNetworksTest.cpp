#include <gtest/gtest.h>

#include <algorithm>

#include "shared/net/lan/LanNetworks.h"

namespace naiad {
namespace {

LanNetwork lanNetworkOf(unsigned interface, const std::string& address, unsigned prefix) {
  return {interface, "eth" + std::to_string(interface), asio::ip::make_address(address), prefix, false,
          false};
}

bool contains(const LanNetwork& network, const std::string& address) {
  return network.contains(asio::ip::make_address(address));
}

TEST(LanNetworks, NetworkContainsAddressesWithItsPrefix) {
  EXPECT_TRUE(contains(lanNetworkOf(1, "192.168.1.7", 24), "192.168.1.255"));
  EXPECT_FALSE(contains(lanNetworkOf(1, "192.168.1.7", 24), "192.168.2.7"));
  EXPECT_TRUE(contains(lanNetworkOf(1, "10.1.2.3", 20), "10.1.15.9"));
  EXPECT_FALSE(contains(lanNetworkOf(1, "10.1.2.3", 20), "10.1.16.0"));
  EXPECT_FALSE(contains(lanNetworkOf(1, "10.1.2.3", 32), "10.1.2.2"));
  EXPECT_TRUE(contains(lanNetworkOf(1, "10.1.2.3", 0), "203.0.113.9"));
  EXPECT_TRUE(contains(lanNetworkOf(1, "fe80::1", 64), "fe80::2%lo")) << "zones do not count";
  EXPECT_TRUE(contains(lanNetworkOf(1, "fd00:0:0:7::1", 63), "fd00:0:0:6::9"));
  EXPECT_FALSE(contains(lanNetworkOf(1, "fd00:0:0:7::1", 64), "fd00:0:0:6::9"));
  EXPECT_FALSE(contains(lanNetworkOf(1, "0.0.0.0", 0), "fd00::1")) << "another family";
}

bool isPrivate(std::vector<LanNetwork> networks) {
  markPrivate(networks);
  return networks[0].is_private;
}

TEST(LanNetworks, HomeAndOfficeRangesArePrivate) {
  for (const char* p_address :
       {"10.255.0.1", "172.16.0.1", "172.31.255.1", "192.168.9.1", "169.254.3.4", "fd00::1", "fc12::1"})
    EXPECT_TRUE(isPrivate({lanNetworkOf(1, p_address, 24)})) << p_address;
  for (const char* p_address : {"11.0.0.1", "172.15.0.1", "172.32.0.1", "192.169.0.1", "192.0.2.1",
                                "100.64.0.1", "127.0.0.1", "2001:db8::1", "fe00::1"})
    EXPECT_FALSE(isPrivate({lanNetworkOf(1, p_address, 24)})) << p_address;
}

TEST(LanNetworks, LinkLocalNetworkIsAsPrivateAsItsInterface) {
  const LanNetwork link = lanNetworkOf(1, "fe80::1", 64);
  EXPECT_TRUE(isPrivate({link}));
  EXPECT_TRUE(isPrivate({link, lanNetworkOf(1, "192.168.1.1", 24), lanNetworkOf(1, "2001:db8::1", 64)}));
  EXPECT_FALSE(isPrivate({link, lanNetworkOf(1, "198.51.100.7", 24)})) << "a rented server";
  EXPECT_FALSE(isPrivate({link, lanNetworkOf(1, "2001:db8::1", 64), lanNetworkOf(2, "192.168.1.1", 24)}));
}

TEST(LanNetworks, ListHasLoopbackAndNoDuplicates) {
  const auto networks = lanNetworks();
  ASSERT_LE(networks.size(), kMaxLanNetworks);
  for (const LanNetwork& network : networks) {
    EXPECT_NE(network.interface, 0u);
    EXPECT_TRUE(network.contains(network.address));
    EXPECT_EQ(std::count(networks.begin(), networks.end(), network), 1) << network.name;
  }
  const bool has_loopback = std::any_of(networks.begin(), networks.end(), [](const LanNetwork& network) {
    return network.is_loopback && network.address.is_loopback();
  });
  EXPECT_TRUE(has_loopback);
}

}  // namespace
}  // namespace naiad
