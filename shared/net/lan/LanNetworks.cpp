#include "shared/net/lan/LanNetworks.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>

namespace naiad {
namespace {

template <class Bytes>
bool haveSameBegin(const Bytes& a, const Bytes& b, unsigned bits) {
  for (std::size_t i = 0; i < a.size() && bits > 0; ++i) {
    const unsigned here = std::min(bits, 8u);
    const unsigned mask = 0xffu << (8 - here) & 0xffu;
    if (((a[i] ^ b[i]) & mask) != 0) return false;
    bits -= here;
  }
  return true;
}

bool isIn(const asio::ip::address_v4& address, const char* network, unsigned bits) {
  return haveSameBegin(address.to_bytes(), asio::ip::make_address_v4(network).to_bytes(), bits);
}

bool isLinkLocal6(const asio::ip::address& address) {
  return address.is_v6() && address.to_v6().is_link_local();
}

bool isOfPrivateRange(const asio::ip::address& address) {
  if (address.is_v6()) return (address.to_v6().to_bytes()[0] & 0xfe) == 0xfc;
  const auto four = address.to_v4();
  return isIn(four, "10.0.0.0", 8) || isIn(four, "172.16.0.0", 12) || isIn(four, "192.168.0.0", 16) ||
         isIn(four, "169.254.0.0", 16);
}

/// Nothing for families other than IP.
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

template <class Bytes>
unsigned countBits(const Bytes& bytes) {
  unsigned bits = 0;
  for (const unsigned char byte : bytes) bits += static_cast<unsigned>(std::popcount(byte));
  return bits;
}

unsigned prefixOf(const asio::ip::address& mask) {
  return mask.is_v4() ? countBits(mask.to_v4().to_bytes()) : countBits(mask.to_v6().to_bytes());
}

/// Is this address of the interface one to ask, or answer, from? Systems have no route for IPv6 groups on
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
  if (other.is_v4() != address.is_v4()) return false;
  if (address.is_v4()) return haveSameBegin(address.to_v4().to_bytes(), other.to_v4().to_bytes(), prefix);
  return haveSameBegin(address.to_v6().to_bytes(), other.to_v6().to_bytes(), prefix);
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
