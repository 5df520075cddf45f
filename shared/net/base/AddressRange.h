// Ranges of addresses (192.0.2.0/24, 2001:db8::/32), and whether an address is local, private or public.
#pragma once

#include <array>
#include <asio/ip/address.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// From how far an address can be reached: a stranger far away must not send a client to what is near it.
/// The nearest first.
enum class AddressReach {
  kNone,     ///< no machine: multicast, broadcast, reserved
  kSelf,     ///< this machine: 127/8, 0/8, ::1, ::
  kPrivate,  ///< its neighbours: RFC 1918, 6598 (100.64/10), 3927 (169.254/16), 4193 (fc00::/7), fe80::/10
  kPublic,
};

/// Of IPv6 that carries an IPv4 address (mapped, NAT64 64:ff9b::/96, 6to4 2002::/16), that of the latter.
AddressReach reachOf(const asio::ip::address& address);

/// May what is at `from` send a client to `to`? Not to what is nearer.
inline bool maySendTo(const asio::ip::address& from, const asio::ip::address& to) {
  return reachOf(to) != AddressReach::kNone && reachOf(to) >= reachOf(from);
}

/// All addresses of one family that begin with the same bits.
class AddressRange {
 public:
  using Bytes = std::array<std::uint8_t, 16>;  ///< as those of AddressPrefix

  /// ADDRESS/BITS, or an address: IPv4 alone, IPv6 with its /64, which is what a household has. IPv4 mapped
  /// into IPv6 is IPv4. Bits beyond the length are cleared. Nothing for other texts.
  static std::optional<AddressRange> parse(std::string_view text);
  /// The same of one address.
  static AddressRange around(const asio::ip::address& address);

  bool contains(const asio::ip::address& address) const;
  bool isIPv4() const { return m_ipv4; }
  /// Of the 32 or 128.
  int bits() const { return m_ipv4 ? m_length - kMappedBits : m_length; }
  /// "192.0.2.7", "192.0.2.0/24", "2001:db8::/64"; parse() reads it back.
  std::string text() const;

  /// Of the 128 bits of a mapped address; the key with bytes().
  int length() const { return m_length; }
  const Bytes& bytes() const { return m_bytes; }
  /// The first `length` bits of an address, the others zero.
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

/// The address in "127.0.0.1:40000" or "[::1]:40000"; IPv4 mapped into IPv6 as IPv4. Nothing for other texts.
std::optional<asio::ip::address> endpointAddress(std::string_view text);

}  // namespace naiad
