// The local networks of this machine in which LAN queries are sent and answered.
#pragma once

#include <asio/ip/address.hpp>
#include <string>
#include <vector>

namespace naiad {

/// An address of one of this machine's interfaces, and the network around it.
struct LanNetwork {
  unsigned interface = 0;     ///< the system's index of the interface, never 0
  std::string name;           ///< name of the interface: "eth0"
  asio::ip::address address;  ///< the address, without a zone
  unsigned prefix = 0;        ///< number of address bits that are equal in the whole network
  bool is_loopback = false;
  bool is_private = false;  ///< see markPrivate()

  /// True if `other` is an address of this network. Zones are ignored.
  bool contains(const asio::ip::address& other) const;

  friend bool operator==(const LanNetwork&, const LanNetwork&) = default;
};

/// Returns this machine's current networks, at most kMaxLanNetworks: those of interfaces that are up, are
/// loopback (only IPv4) or can multicast, and are not point-to-point (tunnels, modems). Empty if the system
/// does not list them.
std::vector<LanNetwork> lanNetworks();

inline constexpr std::size_t kMaxLanNetworks = 32;

/// Sets `is_private` for addresses of RFC 1918, 169.254/16 and fc00::/7, and for those of fe80::/10 on an
/// interface with another private address, or with no other address. A rented server with a public address
/// has an fe80::/10 address too, and its neighbours are strangers.
void markPrivate(std::vector<LanNetwork>& networks);

}  // namespace naiad
