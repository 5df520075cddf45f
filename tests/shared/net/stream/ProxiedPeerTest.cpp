#include <gtest/gtest.h>

#include "shared/net/stream/ProxiedPeer.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad {
namespace {

TEST(ProxiedPeer, HaveTheSameAddressInEachForm) {
  for (const char* const text : {"192.0.2.7:50312", "[2001:db8::7]:50313"}) {
    const auto endpoint = *proxiedPeerFromText(text);
    const auto address = endpoint.address().is_v6()
                             ? endpoint.address().to_v6()
                             : asio::ip::make_address_v6(asio::ip::v4_mapped, endpoint.address().to_v4());
    const auto visitor = ProxiedPeer::of(address.to_bytes(), endpoint.port());
    EXPECT_EQ(visitor.name, text);
    EXPECT_EQ(visitor.prefix, AddressPrefix::of(endpoint.address()));
    EXPECT_EQ(readProxyHeader(visitor.header), endpoint);
  }
}

}  // namespace
}  // namespace naiad
