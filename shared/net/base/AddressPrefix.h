// The key of per-address limits (an IPv4 address or an IPv6 /64 network), and an address with a port.
#pragma once

#include <array>
#include <asio/ip/address.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace naiad {

/// The first bytes of an IPv4 address that is mapped into IPv6: ::ffff:a.b.c.d.
inline constexpr std::array<std::uint8_t, 12> kMappedIPv4{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

/// The unit of per-address limits: a household has one IPv4 address, or a /64 of IPv6 addresses.
class AddressPrefix {
 public:
  /// The network-order bytes of an IPv6 address, or of an IPv4 address mapped into IPv6 (::ffff:a.b.c.d).
  using Bytes = std::array<std::uint8_t, 16>;

  AddressPrefix() = default;
  explicit AddressPrefix(const Bytes& address);
  /// Returns the /32 of an IPv4 address (mapped into IPv6 or not), or the /64 of an IPv6 address.
  static AddressPrefix of(const asio::ip::address& address);
  /// Returns the prefix of "127.0.0.1:40000" or "[::1]:40000" (ReliableChannel::peerAddress()), else nullopt.
  static std::optional<AddressPrefix> ofEndpoint(std::string_view text);

  /// Returns the range of a small customer: the /24 of an IPv4 address, the /56 of an IPv6 network.
  AddressPrefix wide() const;
  /// Returns the range of a large customer: the /24 of an IPv4 address, the /48 of an IPv6 network.
  AddressPrefix widest() const;

  friend bool operator==(const AddressPrefix&, const AddressPrefix&) = default;
  friend bool operator<(const AddressPrefix& a, const AddressPrefix& b) { return a.bits_ < b.bits_; }

 private:
  bool isIPv4() const;
  AddressPrefix without(std::size_t bytes) const;

  /// The lower half of a mapped IPv4 address, or the upper half of an IPv6 address. An IPv4 value never
  /// equals an IPv6 one, because ::/8 is reserved.
  std::uint64_t bits_ = 0;
};

/// Returns an IPv4 address for one that is mapped into IPv6, and other addresses unchanged.
asio::ip::address unmapped(const asio::ip::address& address);

/// "127.0.0.1:40000" or "[::1]:40000": an address, IPv6 in brackets, and a port of 0 … 65535.
struct NumericEndpoint {
  asio::ip::address address;
  std::uint16_t port = 0;

  /// Parses the text; returns nullopt if it has another form.
  static std::optional<NumericEndpoint> parse(std::string_view text);
};

}  // namespace naiad
