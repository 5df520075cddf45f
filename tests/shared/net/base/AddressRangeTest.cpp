// Ranges of addresses, and the scope of an address (own machine, private network, public), in all their
// spellings.
#include <gtest/gtest.h>

#include <string>
#include <vector>

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

void expectAll(AddressScope wanted, const std::vector<std::string>& addresses) {
  for (const std::string& text : addresses) EXPECT_EQ(scopeOf(asio::ip::make_address(text)), wanted) << text;
}

TEST(AddressScopeTest, EachAddressHasItsScope) {
  expectAll(AddressScope::kSelf, {"127.0.0.1", "127.255.255.254", "0.0.0.0", "0.1.2.3", "::1",
                                  "::", "::ffff:127.0.0.1", "64:ff9b::7f00:1", "2002:7f00:1::"});
  expectAll(AddressScope::kPrivate,
            {"10.0.0.1", "172.16.0.1", "172.31.255.255", "192.168.1.1", "169.254.169.254", "100.64.0.1",
             "fc00::1", "fdff::1", "fe80::1", "::ffff:10.0.0.1", "64:ff9b::a00:1", "2002:c0a8:101::1"});
  expectAll(AddressScope::kPublic, {"192.0.2.7", "9.255.255.255", "11.0.0.0", "172.15.0.1", "172.32.0.1",
                                    "192.167.1.1", "100.63.0.1", "100.128.0.1", "126.0.0.1", "128.0.0.1",
                                    "2001:db8::7", "::ffff:192.0.2.7", "2002:c000:207::"});
  expectAll(AddressScope::kNone, {"224.0.0.1", "255.255.255.255", "240.0.0.1", "ff02::1", "::2", "::7f00:1"});
}

TEST(AddressScopeTest, RedirectToANearerScopeIsForbidden) {
  const std::string from_near_to_far[] = {"127.0.0.1", "192.168.1.1", "192.0.2.7"};
  for (int from = 0; from < 3; ++from) {
    for (int to = 0; to < 3; ++to)
      EXPECT_EQ(mayRedirectTo(asio::ip::make_address(from_near_to_far[from]),
                              asio::ip::make_address(from_near_to_far[to])),
                to >= from);
  }
  EXPECT_FALSE(mayRedirectTo(asio::ip::make_address("127.0.0.1"), asio::ip::make_address("224.0.0.1")));
}

}  // namespace
}  // namespace naiad
