#include "shared/net/lan/LanSocket.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace naiad {
namespace {

constexpr int kBuffer = 64 * 1024;  // receive buffer in bytes; the system drops packets beyond it

#ifndef IPV6_MULTICAST_ALL
constexpr int IPV6_MULTICAST_ALL = 29;
#endif

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void require(int result, const char* what) {
  if (result != 0) fail(what);
}

int setInt(int descriptor, int level, int option, int value) {
  return ::setsockopt(descriptor, level, option, &value, sizeof value);
}

asio::ip::udp::endpoint group(LanSocket::Family family) {
  const char* address = family == LanSocket::Family::kIPv4 ? kLanGroup4 : kLanGroup6;
  return {asio::ip::make_address(address), kLanPort};
}

void bindTo(int descriptor, const asio::ip::udp::endpoint& endpoint) {
  require(::bind(descriptor, endpoint.data(), static_cast<socklen_t>(endpoint.size())), "bind");
}

asio::ip::udp::endpoint endpointOf(const sockaddr_storage& address) {
  asio::ip::udp::endpoint endpoint;
  if (address.ss_family == AF_INET6) endpoint = {asio::ip::address_v6(), 0};
  std::memcpy(endpoint.data(), &address, endpoint.size());
  return endpoint;
}

template <class Value>
Value valueOf(const cmsghdr& header) {
  Value value;
  std::memcpy(&value, CMSG_DATA(&header), sizeof value);
  return value;
}

asio::ip::address_v6 sixOf(const in6_addr& address) {
  asio::ip::address_v6::bytes_type bytes;
  std::memcpy(bytes.data(), &address, bytes.size());
  return asio::ip::address_v6(bytes);
}

void readFour(const in_pktinfo& info, LanPacket& packet) {
  packet.interface = static_cast<unsigned>(info.ipi_ifindex);
  packet.to_group = ntohl(info.ipi_addr.s_addr) == asio::ip::make_address_v4(kLanGroup4).to_uint();
}

void readSix(const in6_pktinfo& info, LanPacket& packet) {
  packet.interface = info.ipi6_ifindex;
  packet.to_group = sixOf(info.ipi6_addr) == asio::ip::make_address_v6(kLanGroup6);
}

void readFacts(msghdr& message, LanPacket& packet) {
  for (cmsghdr* p_header = CMSG_FIRSTHDR(&message); p_header != nullptr;
       p_header = CMSG_NXTHDR(&message, p_header)) {
    const bool four = p_header->cmsg_level == IPPROTO_IP;
    const bool six = p_header->cmsg_level == IPPROTO_IPV6;
    if (four && p_header->cmsg_type == IP_TTL) packet.hop_limit = valueOf<int>(*p_header);
    if (six && p_header->cmsg_type == IPV6_HOPLIMIT) packet.hop_limit = valueOf<int>(*p_header);
    if (four && p_header->cmsg_type == IP_PKTINFO) readFour(valueOf<in_pktinfo>(*p_header), packet);
    if (six && p_header->cmsg_type == IPV6_PKTINFO) readSix(valueOf<in6_pktinfo>(*p_header), packet);
  }
}

template <class Info>
void putInfo(msghdr& message, int level, int type, const Info& info) {
  message.msg_controllen = CMSG_SPACE(sizeof info);
  cmsghdr* const p_header = CMSG_FIRSTHDR(&message);
  p_header->cmsg_level = level;
  p_header->cmsg_type = type;
  p_header->cmsg_len = CMSG_LEN(sizeof info);
  std::memcpy(CMSG_DATA(p_header), &info, sizeof info);
}

void putSource(msghdr& message, const LanNetwork& from) {
  if (from.address.is_v4()) {
    in_pktinfo info{};
    info.ipi_ifindex = static_cast<int>(from.interface);
    info.ipi_spec_dst.s_addr = htonl(from.address.to_v4().to_uint());
    return putInfo(message, IPPROTO_IP, IP_PKTINFO, info);
  }
  in6_pktinfo info{};
  const auto bytes = from.address.to_v6().to_bytes();
  std::memcpy(&info.ipi6_addr, bytes.data(), bytes.size());
  info.ipi6_ifindex = from.interface;
  putInfo(message, IPPROTO_IPV6, IPV6_PKTINFO, info);
}

}  // namespace

LanSocket::LanSocket(Family family)
    : m_family(family),
      m_descriptor(::socket(family == Family::kIPv4 ? AF_INET : AF_INET6,
                            SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (m_descriptor < 0) fail("socket");
  const int file = m_descriptor;
  setInt(file, SOL_SOCKET, SO_RCVBUF, kBuffer);
  if (family == Family::kIPv4) {
    require(setInt(file, IPPROTO_IP, IP_TTL, kLanHopLimit), "IP_TTL");
    require(setInt(file, IPPROTO_IP, IP_MULTICAST_TTL, kLanHopLimit), "IP_MULTICAST_TTL");
    require(setInt(file, IPPROTO_IP, IP_RECVTTL, 1), "IP_RECVTTL");
    require(setInt(file, IPPROTO_IP, IP_PKTINFO, 1), "IP_PKTINFO");
    require(setInt(file, IPPROTO_IP, IP_MULTICAST_ALL, 0), "IP_MULTICAST_ALL");
    return;
  }
  require(setInt(file, IPPROTO_IPV6, IPV6_V6ONLY, 1), "IPV6_V6ONLY");
  require(setInt(file, IPPROTO_IPV6, IPV6_UNICAST_HOPS, kLanHopLimit), "IPV6_UNICAST_HOPS");
  require(setInt(file, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, kLanHopLimit), "IPV6_MULTICAST_HOPS");
  require(setInt(file, IPPROTO_IPV6, IPV6_RECVHOPLIMIT, 1), "IPV6_RECVHOPLIMIT");
  require(setInt(file, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1), "IPV6_RECVPKTINFO");
  setInt(file, IPPROTO_IPV6, IPV6_MULTICAST_ALL,
         0);  // since Linux 4.20; callers check the packet's interface, too
}

LanSocket::LanSocket(LanSocket&& other) noexcept
    : m_family(other.m_family), m_descriptor(std::exchange(other.m_descriptor, -1)) {}

LanSocket::~LanSocket() {
  if (m_descriptor >= 0) ::close(m_descriptor);
}

LanSocket LanSocket::forServer(Family family) {
  LanSocket socket(family);
  // Several servers share the port: each of their sockets receives every packet to the group.
  require(setInt(socket.m_descriptor, SOL_SOCKET, SO_REUSEADDR, 1), "SO_REUSEADDR");
  // IPv4 binds to the group, so that no other packets are received. For IPv6, a group of link-local scope
  // would need a socket for each interface.
  const asio::ip::udp::endpoint any(asio::ip::udp::v6(), kLanPort);
  bindTo(socket.m_descriptor, family == Family::kIPv4 ? group(family) : any);
  return socket;
}

LanSocket LanSocket::forClient(Family family) {
  LanSocket socket(family);
  bindTo(socket.m_descriptor, {family == Family::kIPv4 ? asio::ip::udp::v4() : asio::ip::udp::v6(), 0});
  return socket;
}

bool LanSocket::joinGroup(unsigned interface) {
  int result = 0;
  if (m_family == Family::kIPv4) {
    ip_mreqn request{};
    request.imr_multiaddr.s_addr = htonl(asio::ip::make_address_v4(kLanGroup4).to_uint());
    request.imr_ifindex = static_cast<int>(interface);
    result = ::setsockopt(m_descriptor, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request);
  } else {
    ipv6_mreq request{};
    const auto bytes = asio::ip::make_address_v6(kLanGroup6).to_bytes();
    std::memcpy(&request.ipv6mr_multiaddr, bytes.data(), bytes.size());
    request.ipv6mr_interface = interface;
    result = ::setsockopt(m_descriptor, IPPROTO_IPV6, IPV6_JOIN_GROUP, &request, sizeof request);
  }
  return result == 0 || errno == EADDRINUSE;
}

std::optional<LanPacket> LanSocket::receivePacket() {
  sockaddr_storage source{};
  iovec part{m_bytes.data(), m_bytes.size()};
  alignas(cmsghdr) char control[256];
  msghdr message{};
  message.msg_name = &source;
  message.msg_namelen = sizeof source;
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  ssize_t size = 0;
  // A pending ICMP error is reported before the packets that wait behind it.
  for (int tries = 0; tries < 8; ++tries) {
    size = ::recvmsg(m_descriptor, &message, 0);
    if (size >= 0 || errno == EAGAIN || errno == EWOULDBLOCK) break;
  }
  if (size < 0) return std::nullopt;
  LanPacket packet;
  packet.source = endpointOf(source);
  packet.bytes = {m_bytes.data(), static_cast<std::size_t>(size)};
  readFacts(message, packet);
  return packet;
}

bool LanSocket::sendQuery(const LanNetwork& from, std::string_view bytes) {
  return send(from, group(m_family), bytes, 0);
}

bool LanSocket::sendAnswer(const LanNetwork& from, const asio::ip::udp::endpoint& to,
                           std::string_view bytes) {
  return send(from, to, bytes, MSG_DONTROUTE);
}

bool LanSocket::send(const LanNetwork& from, const asio::ip::udp::endpoint& to, std::string_view bytes,
                     int flags) {
  asio::ip::udp::endpoint target = to;
  iovec part{const_cast<char*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(in6_pktinfo))]{};
  msghdr message{};
  message.msg_name = target.data();
  message.msg_namelen = static_cast<socklen_t>(target.size());
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  putSource(message, from);
  return ::sendmsg(m_descriptor, &message, flags | MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

std::vector<LanSocket> openLanSockets(LanSocket (*p_open)(LanSocket::Family family)) {
  std::vector<LanSocket> sockets;
  std::optional<std::system_error> failure;
  for (const auto family : {LanSocket::Family::kIPv4, LanSocket::Family::kIPv6}) {
    try {
      sockets.push_back(p_open(family));
    } catch (const std::system_error& error) {
      failure = error;
    }
  }
  if (sockets.empty()) throw *failure;
  return sockets;
}

}  // namespace naiad
