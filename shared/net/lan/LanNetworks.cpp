#include "shared/net/lan/LanNetworks.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <bit>
#include <cstring>
#include <memory>
#include <optional>

#include "shared/net/base/AddressRange.h"

namespace naiad {
namespace {

/// True if both addresses are of one family and their first `bits` bits, of 32 or 128, are equal.
bool haveSameBegin(const asio::ip::address& a, const asio::ip::address& b, unsigned bits) {
  const int length = static_cast<int>(bits) + (a.is_v4() ? 96 : 0);  // prefix length in a mapped address
  return a.is_v4() == b.is_v4() && AddressRange::masked(AddressRange::bytesOf(a), length) ==
                                       AddressRange::masked(AddressRange::bytesOf(b), length);
}

bool isIn(const asio::ip::address& address, const char* network, unsigned bits) {
  return haveSameBegin(address, asio::ip::make_address(network), bits);
}

bool isLinkLocal6(const asio::ip::address& address) {
  return address.is_v6() && address.to_v6().is_link_local();
}

bool isOfPrivateRange(const asio::ip::address& address) {
  return isIn(address, "fc00::", 7) || isIn(address, "10.0.0.0", 8) || isIn(address, "172.16.0.0", 12) ||
         isIn(address, "192.168.0.0", 16) || isIn(address, "169.254.0.0", 16);
}

/// Returns nullopt for null and for families other than IP.
std::optional<asio::ip::address> addressOf(const sockaddr* p_address) {
  if (p_address == nullptr) return std::nullopt;
  if (p_address->sa_family == AF_INET) {
    sockaddr_in four;
    std::memcpy(&four, p_address, sizeof four);
    return asio::ip::address_v4(ntohl(four.sin_addr.s_addr));
  }
  if (p_address->sa_family != AF_INET6) return std::nullopt;
  sockaddr_in6 six;
  std::memcpy(&six, p_address, sizeof six);
  asio::ip::address_v6::bytes_type bytes;
  std::memcpy(bytes.data(), &six.sin6_addr, bytes.size());
  return asio::ip::address_v6(bytes);
}

unsigned prefixOf(const asio::ip::address& mask) {
  unsigned bits = 0;
  for (const unsigned char byte : AddressRange::bytesOf(mask))
    bits += static_cast<unsigned>(std::popcount(byte));
  return mask.is_v4() ? bits - 16 : bits;  // without the 16 one bits (ffff) before a mapped address
}

/// True if an interface with these flags can use the address. Systems have no route for IPv6 groups on
/// loopback.
bool isSuitable(unsigned flags, const asio::ip::address& address) {
  if ((flags & IFF_UP) == 0 || (flags & IFF_POINTOPOINT) != 0) return false;
  return (flags & IFF_LOOPBACK) != 0 ? address.is_v4() : (flags & IFF_MULTICAST) != 0;
}

std::optional<LanNetwork> networkOf(const ifaddrs& entry) {
  const auto address = addressOf(entry.ifa_addr);
  const auto mask = addressOf(entry.ifa_netmask);
  const unsigned interface = if_nametoindex(entry.ifa_name);
  if (!address || !mask || interface == 0 || !isSuitable(entry.ifa_flags, *address)) return std::nullopt;
  const bool loopback = (entry.ifa_flags & IFF_LOOPBACK) != 0;
  return LanNetwork{interface, entry.ifa_name, *address, prefixOf(*mask), loopback, false};
}

}  // namespace

bool LanNetwork::contains(const asio::ip::address& other) const {
  return haveSameBegin(address, other, prefix);
}

std::vector<LanNetwork> lanNetworks() {
  ifaddrs* p_first = nullptr;
  if (getifaddrs(&p_first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> entries(p_first, &freeifaddrs);
  std::vector<LanNetwork> networks;
  for (const ifaddrs* p_entry = p_first; p_entry != nullptr; p_entry = p_entry->ifa_next) {
    auto network = networkOf(*p_entry);
    if (network && networks.size() < kMaxLanNetworks) networks.push_back(*std::move(network));
  }
  markPrivate(networks);
  return networks;
}

void markPrivate(std::vector<LanNetwork>& networks) {
  for (LanNetwork& network : networks) {
    network.is_private = isOfPrivateRange(network.address);
    if (!isLinkLocal6(network.address)) continue;
    bool has_private = false;
    bool has_other = false;
    for (const LanNetwork& other : networks) {
      if (other.interface != network.interface || isLinkLocal6(other.address)) continue;
      has_other = true;
      has_private = has_private || isOfPrivateRange(other.address);
    }
    network.is_private = has_private || !has_other;
  }
}

}  // namespace naiad
