// Where datagrams come from and go to.
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

/// An IP address and a UDP port. IPv4 addresses are kept as IPv6 ones (::ffff:a.b.c.d), so that an address is
/// the same whichever kind of socket saw it.
struct Endpoint {
  std::array<std::uint8_t, 16> address{};  ///< network order; all zero: any
  std::uint32_t scope = 0;                 ///< interface of a link-local IPv6 address, else 0
  std::uint16_t port = 0;

  friend auto operator<=>(const Endpoint&, const Endpoint&) = default;
  /// Asked several times for each datagram.
  friend bool operator==(const Endpoint& a, const Endpoint& b) {
    return a.port == b.port && a.scope == b.scope && a.half(0) == b.half(0) && a.half(1) == b.half(1);
  }
  /// Eight bytes of the address, as they lie in memory.
  std::uint64_t half(std::size_t which) const {
    std::uint64_t bits = 0;
    std::memcpy(&bits, address.data() + 8 * which, sizeof bits);
    return bits;
  }

  bool isIPv4() const;
  AddressPrefix prefix() const { return AddressPrefix(address); }
  /// No particular address: :: or 0.0.0.0.
  bool isAny() const;
};

/// From a numeric address ("127.0.0.1", "::1", "fe80::1%2"); nothing if it is none.
std::optional<Endpoint> makeEndpoint(std::string_view address, std::uint16_t port);
/// "127.0.0.1:40000" or "[::1]:40000".
std::string toString(const Endpoint& endpoint);
/// The inverse; nothing if the text is none.
std::optional<Endpoint> endpointFromText(std::string_view text);

/// Both ends of a datagram, as this side sees them. A reply goes along the path its cause came by, so it
/// leaves from the address that was addressed.
struct Path {
  Endpoint local;  ///< any address: let the system choose
  Endpoint remote;
  friend auto operator<=>(const Path&, const Path&) = default;
};

/// "127.0.0.1:9876 <- 127.0.0.1:40000", for logs.
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
