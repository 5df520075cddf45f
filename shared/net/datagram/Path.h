// The addresses between which datagrams travel.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// An IP address and a UDP port. IPv4 addresses are stored as IPv6 ones (::ffff:a.b.c.d), so that they
/// compare equal whichever kind of socket saw them.
struct Endpoint {
  std::array<std::uint8_t, 16> address{};  ///< network byte order; see isAny()
  std::uint32_t scope = 0;                 ///< interface of a link-local IPv6 address, else 0
  std::uint16_t port = 0;

  friend auto operator<=>(const Endpoint&, const Endpoint&) = default;
  /// Must be fast, because it runs several times per datagram.
  friend bool operator==(const Endpoint& a, const Endpoint& b) {
    return a.port == b.port && a.scope == b.scope && a.half(0) == b.half(0) && a.half(1) == b.half(1);
  }
  /// Returns the first (`which` = 0) or last (1) eight bytes of the address in memory order.
  std::uint64_t half(std::size_t which) const {
    std::uint64_t bits = 0;
    std::memcpy(&bits, address.data() + 8 * which, sizeof bits);
    return bits;
  }

  bool isIPv4() const;
  AddressPrefix prefix() const { return AddressPrefix(address); }
  /// True for :: and 0.0.0.0, which stand for any address.
  bool isAny() const;
};

/// Makes an endpoint from a numeric address ("127.0.0.1", "::1", "fe80::1%2"); nullopt for other texts.
std::optional<Endpoint> makeEndpoint(std::string_view address, std::uint16_t port);
/// Returns "127.0.0.1:40000" or "[::1]:40000".
std::string toString(const Endpoint& endpoint);
/// Parses the format of toString(); nullopt for other texts.
std::optional<Endpoint> endpointFromText(std::string_view text);

/// Both ends of a datagram, as this side sees them. A reply uses the path of the packet it answers, so it
/// leaves from the address to which that packet was sent.
struct Path {
  Endpoint local;  ///< the system chooses one if isAny()
  Endpoint remote;
  friend auto operator<=>(const Path&, const Path&) = default;
};

/// Returns "127.0.0.1:9876 <- 127.0.0.1:40000", for logs.
std::string toString(const Path& path);

}  // namespace naiad

template <>
struct std::hash<naiad::Endpoint> {
  std::size_t operator()(const naiad::Endpoint& endpoint) const noexcept;
};

template <>
struct std::hash<naiad::Path> {
  std::size_t operator()(const naiad::Path& path) const noexcept;
};
