// The networks that this machine is in, as far as its neighbours are asked, or answered, there.
#pragma once

#include <asio/ip/address.hpp>
#include <string>
#include <vector>

namespace naiad {

/// An address of one of this machine's interfaces, and the network around it.
struct LanNetwork {
  unsigned interface = 0;     ///< its number in the system, never 0
  std::string name;           ///< of the interface: "eth0"
  asio::ip::address address;  ///< without a zone
  unsigned prefix = 0;        ///< bits of the address that all of the network have in common
  bool is_loopback = false;
  bool is_private = false;  ///< see markPrivate()

  /// Is `other` an address of this network? Zones do not count.
  bool contains(const asio::ip::address& other) const;

  friend bool operator==(const LanNetwork&, const LanNetwork&) = default;
};

/// Of this machine now: those of interfaces that are up, are loopback (IPv4 alone) or can multicast, and do
/// not lead to a single far end (tunnels, modems). At most kMaxLanNetworks. Empty where the system does not
/// say.
std::vector<LanNetwork> lanNetworks();

inline constexpr std::size_t kMaxLanNetworks = 32;

/// Sets `is_private`: the address is one of RFC 1918, of 169.254/16 or of fc00::/7; or it is one of fe80::/10
/// on an interface that has a private one as well, or no other at all. A rented server with a public address
/// has fe80::/10 too, and neighbours that are strangers.
void markPrivate(std::vector<LanNetwork>& networks);

}  // namespace naiad
