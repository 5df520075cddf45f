// Ranges of addresses (192.0.2.0/24, 2001:db8::/32), and whether an address is local, private or public.
#pragma once

#include <array>
#include <asio/ip/address.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The scope in which an address can be reached, narrowest first. A distant server must not redirect a client
/// to a machine in the client's own network.
enum class AddressScope {
  kNone,     ///< not one machine: multicast, broadcast, reserved
  kSelf,     ///< this machine: 127/8, 0/8, ::1, ::
  kPrivate,  ///< a private network: RFC 1918, 6598 (100.64/10), 3927 (169.254/16), 4193 (fc00::/7), fe80::/10
  kPublic,
};

/// Returns the scope of an address. IPv6 that carries an IPv4 address (mapped, NAT64 64:ff9b::/96, 6to4
/// 2002::/16) has the scope of that address.
AddressScope scopeOf(const asio::ip::address& address);

/// True if a server at `from` may redirect a client to `to`: the scope of `to` must not be narrower than that
/// of `from`, and not kNone.
inline bool mayRedirectTo(const asio::ip::address& from, const asio::ip::address& to) {
  return scopeOf(to) != AddressScope::kNone && scopeOf(to) >= scopeOf(from);
}

/// The addresses of one family that begin with given bits.
class AddressRange {
 public:
  using Bytes = std::array<std::uint8_t, 16>;  ///< like AddressPrefix::Bytes

  /// Parses ADDRESS/BITS, or an address alone: an IPv4 address is a range by itself, an IPv6 address stands
  /// for its /64, the network of a household. IPv4 mapped into IPv6 counts as IPv4. Bits beyond the length
  /// are cleared. Returns nullopt for other texts.
  static std::optional<AddressRange> parse(std::string_view text);
  /// Returns the range that parse() returns for an address without /BITS.
  static AddressRange around(const asio::ip::address& address);

  bool contains(const asio::ip::address& address) const;
  bool isIPv4() const { return m_ipv4; }
  /// The length of the common prefix in bits: at most 32 for IPv4, 128 for IPv6.
  int bits() const { return m_ipv4 ? m_length - kMappedBits : m_length; }
  /// Returns "192.0.2.7", "192.0.2.0/24" or "2001:db8::/64", which parse() accepts.
  std::string text() const;

  /// The prefix length in bytes(): for IPv4, 96 more than bits(). With bytes() it identifies the range.
  int length() const { return m_length; }
  const Bytes& bytes() const { return m_bytes; }
  /// Returns the first `length` bits of an address; the other bits are zero.
  static Bytes masked(Bytes bytes, int length);
  static Bytes bytesOf(const asio::ip::address& address);

  friend bool operator==(const AddressRange&, const AddressRange&) = default;

 private:
  static constexpr int kMappedBits = 96;
  AddressRange(const asio::ip::address& address, int bits);

  bool m_ipv4;
  int m_length;
  Bytes m_bytes;
};

/// Returns the address in "127.0.0.1:40000" or "[::1]:40000", mapped IPv4 as IPv4; nullopt for other texts.
std::optional<asio::ip::address> endpointAddress(std::string_view text);

}  // namespace naiad
