// The scope of addresses (own machine, private network, public), in all their spellings.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shared/net/base/AddressRange.h"

namespace naiad {
namespace {

AddressScope reach(const std::string& text) {
  return scopeOf(asio::ip::make_address(text));
}

void expectAll(AddressScope wanted, const std::vector<std::string>& addresses) {
  for (const std::string& text : addresses) EXPECT_EQ(reach(text), wanted) << text;
}

TEST(AddressScopeTest, LoopbackAddressesAreThisMachine) {
  expectAll(AddressScope::kSelf, {"127.0.0.1", "127.255.255.254", "0.0.0.0", "0.1.2.3", "::1",
                                  "::", "::ffff:127.0.0.1", "64:ff9b::7f00:1", "2002:7f00:1::"});
}

TEST(AddressScopeTest, PrivateAndLinkLocalAddressesArePrivate) {
  expectAll(AddressScope::kPrivate,
            {"10.0.0.1", "172.16.0.1", "172.31.255.255", "192.168.1.1", "169.254.169.254", "100.64.0.1",
             "fc00::1", "fdff::1", "fe80::1", "::ffff:10.0.0.1", "64:ff9b::a00:1", "2002:c0a8:101::1"});
}

TEST(AddressScopeTest, OtherAddressesArePublicOrNone) {
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
