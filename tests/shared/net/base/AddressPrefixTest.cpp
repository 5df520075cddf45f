#include <gtest/gtest.h>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

AddressPrefix of(const char* text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

TEST(AddressPrefix, IsTheWholeIPv4Address) {
  EXPECT_EQ(of("192.0.2.1"), of("192.0.2.1"));
  EXPECT_NE(of("192.0.2.1"), of("192.0.2.2"));
  EXPECT_EQ(of("::ffff:192.0.2.1"), of("192.0.2.1"));
  EXPECT_NE(of("0.0.0.0"), of("::"));
}

TEST(AddressPrefix, IsTheFirstHalfOfIPv6) {
  EXPECT_EQ(of("2001:db8:1:2::1"), of("2001:db8:1:2:ffff:ffff:ffff:ffff"));
  EXPECT_NE(of("2001:db8:1:2::1"), of("2001:db8:1:3::1"));
}

TEST(AddressPrefix, IsParsedFromAnEndpoint) {
  EXPECT_EQ(AddressPrefix::ofEndpoint("192.0.2.1:40000"), of("192.0.2.1"));
  EXPECT_EQ(AddressPrefix::ofEndpoint("[2001:db8:1:2::1]:9"), of("2001:db8:1:2::2"));
  for (const char* text :
       {"", "unknown", "virtual:server", ":", "[]:1", "192.0.2.1:junk", "::1:80", "[192.0.2.1]:80"}) {
    EXPECT_FALSE(AddressPrefix::ofEndpoint(text)) << text;
  }
}

TEST(AddressPrefix, HasWiderPrefixesForCustomerNetworks) {
  EXPECT_EQ(of("192.0.2.1").wide(), of("192.0.2.255").wide());
  EXPECT_NE(of("192.0.2.1").wide(), of("192.0.3.1").wide());
  EXPECT_EQ(of("192.0.2.1").widest(), of("192.0.2.255").widest());
  EXPECT_NE(of("192.0.2.1").widest(), of("192.0.3.1").widest()) << "a /24 is the widest of IPv4";
  EXPECT_EQ(of("2001:db8:1:200::1").wide(), of("2001:db8:1:2ff::1").wide());
  EXPECT_NE(of("2001:db8:1:200::1").wide(), of("2001:db8:1:300::1").wide());
  EXPECT_EQ(of("2001:db8:1:200::1").widest(), of("2001:db8:1:ffff::1").widest());
  EXPECT_NE(of("2001:db8:1:200::1").widest(), of("2001:db8:2:200::1").widest());
}

}  // namespace
}  // namespace naiad
