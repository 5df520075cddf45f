// From how far an address can be reached: a stranger far away must not send a client to what is near it.
#pragma once

#include <asio/ip/address.hpp>

namespace naiad {

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

}  // namespace naiad
