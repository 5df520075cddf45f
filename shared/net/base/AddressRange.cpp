#include "shared/net/base/AddressRange.h"

#include <algorithm>
#include <cstddef>
#include <system_error>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

AddressScope reachOfIPv4(const asio::ip::address_v4& address) {
  const std::uint32_t bits = address.to_uint();
  const auto begins = [bits](std::uint32_t prefix, int length) {
    return bits >> (32 - length) == prefix >> (32 - length);
  };
  if (begins(0xe0000000, 3)) return AddressScope::kNone;  // 224/4 multicast, 240/4 reserved
  if (begins(0x7f000000, 8) || begins(0, 8)) return AddressScope::kSelf;
  const bool is_private = begins(0x0a000000, 8) || begins(0xac100000, 12) || begins(0xc0a80000, 16) ||
                          begins(0x64400000, 10) || begins(0xa9fe0000, 16);
  return is_private ? AddressScope::kPrivate : AddressScope::kPublic;
}

asio::ip::address_v4 carried(const asio::ip::address_v6::bytes_type& bytes, std::size_t at) {
  return asio::ip::address_v4({bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]});
}

AddressScope reachOfIPv6(const asio::ip::address_v6& address) {
  constexpr std::array<std::uint8_t, 12> kNat64{0, 0x64, 0xff, 0x9b};
  const auto bytes = address.to_bytes();
  if (std::equal(kMappedIPv4.begin(), kMappedIPv4.end(), bytes.begin()))
    return reachOfIPv4(carried(bytes, 12));
  if (std::equal(kNat64.begin(), kNat64.end(), bytes.begin())) return reachOfIPv4(carried(bytes, 12));
  if (bytes[0] == 0x20 && bytes[1] == 0x02) return reachOfIPv4(carried(bytes, 2));
  if (address.is_loopback() || address.is_unspecified()) return AddressScope::kSelf;
  if (bytes[0] == 0xff) return AddressScope::kNone;
  // IPv4-compatible addresses (::a.b.c.d) and the like are obsolete.
  if (bytes[0] == 0) return AddressScope::kNone;
  const bool is_private = (bytes[0] & 0xfe) == 0xfc || (bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80);
  return is_private ? AddressScope::kPrivate : AddressScope::kPublic;
}

constexpr int kHouseholdBits = 64;  ///< prefix length of a household's IPv6 network

int widthOf(const asio::ip::address& address) {
  return address.is_v4() ? 32 : 128;
}

}  // namespace

AddressScope scopeOf(const asio::ip::address& address) {
  return address.is_v4() ? reachOfIPv4(address.to_v4()) : reachOfIPv6(address.to_v6());
}

AddressRange::AddressRange(const asio::ip::address& address, int bits)
    : m_ipv4(address.is_v4()),
      m_length(m_ipv4 ? kMappedBits + bits : bits),
      m_bytes(masked(bytesOf(address), m_length)) {}

AddressRange::Bytes AddressRange::bytesOf(const asio::ip::address& address) {
  if (address.is_v6()) return address.to_v6().to_bytes();
  return asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4()).to_bytes();
}

AddressRange::Bytes AddressRange::masked(Bytes bytes, int length) {
  for (int i = 0; i < static_cast<int>(bytes.size()); ++i) {
    const int kept = length - 8 * i;
    if (kept <= 0) bytes[static_cast<std::size_t>(i)] = 0;
    if (kept > 0 && kept < 8)
      bytes[static_cast<std::size_t>(i)] &= static_cast<std::uint8_t>(0xff << (8 - kept));
  }
  return bytes;
}

std::optional<AddressRange> AddressRange::parse(std::string_view text) {
  const std::size_t slash = text.find('/');
  std::error_code error;
  const auto typed = asio::ip::make_address(std::string(text.substr(0, slash)), error);
  if (error || (typed.is_v6() && typed.to_v6().scope_id() != 0)) return std::nullopt;
  const asio::ip::address address = unmapped(typed);
  if (slash == std::string_view::npos) return around(address);
  auto bits = readNumber(text.substr(slash + 1), 0, widthOf(typed));
  if (bits && address.is_v4() && typed.is_v6()) *bits -= kMappedBits;
  if (!bits || *bits < 0) return std::nullopt;
  return AddressRange(address, *bits);
}

AddressRange AddressRange::around(const asio::ip::address& address) {
  const asio::ip::address own = unmapped(address);
  return AddressRange(own, own.is_v4() ? widthOf(own) : kHouseholdBits);
}

bool AddressRange::contains(const asio::ip::address& address) const {
  const asio::ip::address own = unmapped(address);
  return own.is_v4() == m_ipv4 && masked(bytesOf(own), m_length) == m_bytes;
}

std::string AddressRange::text() const {
  const asio::ip::address_v6 address(m_bytes);
  const std::string first =
      m_ipv4 ? asio::ip::make_address_v4(asio::ip::v4_mapped, address).to_string() : address.to_string();
  return m_ipv4 && bits() == 32 ? first : first + "/" + std::to_string(bits());
}

std::optional<asio::ip::address> endpointAddress(std::string_view text) {
  const auto endpoint = NumericEndpoint::parse(text);
  return endpoint ? std::optional(unmapped(endpoint->address)) : std::nullopt;
}

}  // namespace naiad
