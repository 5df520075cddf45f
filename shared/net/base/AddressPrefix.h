// Who is one peer, for limits per address: an IPv4 address, or an IPv6 network of 64 bits.
#pragma once

#include <array>
#include <asio/ip/address.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace naiad {

/// A household has one IPv4 address, or a /64 of which it can use any address: so these are what limits count
/// by.
class AddressPrefix {
 public:
  /// The /32 of an IPv4 address (mapped into IPv6 or not), the /64 of an IPv6 address.
  static AddressPrefix of(const asio::ip::address& address);
  /// Of "127.0.0.1:40000" or "[::1]:40000", as ReliableChannel::peerAddress() gives it. Nothing for other
  /// texts.
  static std::optional<AddressPrefix> ofEndpoint(std::string_view text);

  friend bool operator==(const AddressPrefix&, const AddressPrefix&) = default;
  friend bool operator<(const AddressPrefix& a, const AddressPrefix& b) {
    return a.is_v6_ != b.is_v6_ ? b.is_v6_ : a.bytes_ < b.bytes_;
  }

 private:
  bool is_v6_ = false;
  std::array<std::uint8_t, 8> bytes_{};
};

/// IPv4 mapped into IPv6 as IPv4, everything else as it is.
asio::ip::address unmapped(const asio::ip::address& address);

}  // namespace naiad
