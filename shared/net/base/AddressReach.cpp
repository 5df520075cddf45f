#include "shared/net/base/AddressReach.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

AddressReach reachOfIPv4(const asio::ip::address_v4& address) {
  const std::uint32_t bits = address.to_uint();
  const auto begins = [bits](std::uint32_t prefix, int length) {
    return bits >> (32 - length) == prefix >> (32 - length);
  };
  if (begins(0xe0000000, 3)) return AddressReach::kNone;  // 224/4 multicast, 240/4 reserved
  if (begins(0x7f000000, 8) || begins(0, 8)) return AddressReach::kSelf;
  const bool is_private = begins(0x0a000000, 8) || begins(0xac100000, 12) || begins(0xc0a80000, 16) ||
                          begins(0x64400000, 10) || begins(0xa9fe0000, 16);
  return is_private ? AddressReach::kPrivate : AddressReach::kPublic;
}

asio::ip::address_v4 carried(const asio::ip::address_v6::bytes_type& bytes, std::size_t at) {
  return asio::ip::address_v4({bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]});
}

AddressReach reachOfIPv6(const asio::ip::address_v6& address) {
  constexpr std::array<std::uint8_t, 12> kNat64{0, 0x64, 0xff, 0x9b};
  const auto bytes = address.to_bytes();
  if (std::equal(kMappedIPv4.begin(), kMappedIPv4.end(), bytes.begin()))
    return reachOfIPv4(carried(bytes, 12));
  if (std::equal(kNat64.begin(), kNat64.end(), bytes.begin())) return reachOfIPv4(carried(bytes, 12));
  if (bytes[0] == 0x20 && bytes[1] == 0x02) return reachOfIPv4(carried(bytes, 2));
  if (address.is_loopback() || address.is_unspecified()) return AddressReach::kSelf;
  if (bytes[0] == 0xff) return AddressReach::kNone;
  // IPv4-compatible addresses (::a.b.c.d) and the like have no use any more.
  if (bytes[0] == 0) return AddressReach::kNone;
  const bool is_private = (bytes[0] & 0xfe) == 0xfc || (bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80);
  return is_private ? AddressReach::kPrivate : AddressReach::kPublic;
}

}  // namespace

AddressReach reachOf(const asio::ip::address& address) {
  return address.is_v4() ? reachOfIPv4(address.to_v4()) : reachOfIPv6(address.to_v6());
}

}  // namespace naiad
