#include <gtest/gtest.h>

#include "shared/net/base/AddressRange.h"

namespace naiad {
namespace {

bool contains(const char* range, const char* address) {
  return AddressRange::parse(range)->contains(asio::ip::make_address(address));
}

TEST(AddressRange, TextSurvivesTheRoundTrip) {
  for (const char* text : {"192.0.2.7", "192.0.2.0/24", "10.0.0.0/8", "0.0.0.0/0", "2001:db8::/32",
                           "2001:db8:1:2::/64", "2001:db8::7/128", "::/0"})
    EXPECT_EQ(AddressRange::parse(text)->text(), text);
  EXPECT_EQ(AddressRange::parse("192.0.2.77/24")->text(), "192.0.2.0/24");
  EXPECT_EQ(AddressRange::parse("192.0.2.7/32")->text(), "192.0.2.7");
}

TEST(AddressRange, IPv6AddressCoversItsNetwork) {
  EXPECT_EQ(AddressRange::parse("2001:db8::1")->text(), "2001:db8::/64");
  EXPECT_TRUE(contains("2001:db8::1", "2001:db8::ffff:1"));
  EXPECT_FALSE(contains("2001:db8::1", "2001:db8:0:1::1"));
}

TEST(AddressRange, MappedAddressesCountAsIPv4) {
  EXPECT_EQ(AddressRange::parse("::ffff:192.0.2.7")->text(), "192.0.2.7");
  EXPECT_EQ(AddressRange::parse("::ffff:192.0.2.7/120")->text(), "192.0.2.0/24");
  EXPECT_TRUE(contains("192.0.2.0/24", "::ffff:192.0.2.200"));
  EXPECT_FALSE(contains("::/0", "192.0.2.7")) << "all of IPv6 is nothing of IPv4";
  EXPECT_FALSE(contains("0.0.0.0/0", "2001:db8::1"));
}

TEST(AddressRange, StartAndEndAreExact) {
  EXPECT_TRUE(contains("192.0.2.128/25", "192.0.2.128"));
  EXPECT_TRUE(contains("192.0.2.128/25", "192.0.2.255"));
  EXPECT_FALSE(contains("192.0.2.128/25", "192.0.2.127"));
  EXPECT_FALSE(contains("192.0.2.128/25", "192.0.3.128"));
  EXPECT_TRUE(contains("2001:db8:8000::/33", "2001:db8:ffff::1"));
  EXPECT_FALSE(contains("2001:db8:8000::/33", "2001:db8:7fff::1"));
}

TEST(AddressRange, RefusesInvalidRanges) {
  for (const char* text :
       {"", "Ann", "192.0.2", "192.0.2.0/33", "192.0.2.0/-1", "192.0.2.0/", "192.0.2.0/24x", "2001:db8::/129",
        "::ffff:192.0.2.7/80", "fe80::1%lo", "/24", "192.0.2.0/ 24"})
    EXPECT_FALSE(AddressRange::parse(text)) << text;
}

TEST(AddressRange, AddressIsReadFromAnEndpoint) {
  EXPECT_EQ(endpointAddress("192.0.2.7:50312"), std::optional(asio::ip::make_address("192.0.2.7")));
  EXPECT_EQ(endpointAddress("[2001:db8::7]:9"), std::optional(asio::ip::make_address("2001:db8::7")));
  EXPECT_EQ(endpointAddress("[::ffff:192.0.2.7]:9"), std::optional(asio::ip::make_address("192.0.2.7")));
  EXPECT_FALSE(endpointAddress("nowhere"));
}

}  // namespace
}  // namespace naiad
