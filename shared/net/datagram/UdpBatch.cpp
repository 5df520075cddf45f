#include "shared/net/datagram/UdpBatch.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace naiad {
namespace {

constexpr std::size_t kMapped = 12;  // bytes before an IPv4 address in its mapped form

in_addr fourOf(const Endpoint& endpoint) {
  in_addr address;
  std::memcpy(&address, endpoint.address.data() + kMapped, sizeof address);
  return address;
}

in6_addr sixOf(const Endpoint& endpoint) {
  in6_addr address;
  std::memcpy(&address, endpoint.address.data(), sizeof address);
  return address;
}

Endpoint endpointOf(const in_addr& address, std::uint16_t port) {
  Endpoint endpoint;
  endpoint.port = port;
  endpoint.address[10] = endpoint.address[11] = 0xff;
  std::memcpy(endpoint.address.data() + kMapped, &address, sizeof address);
  return endpoint;
}

Endpoint endpointOf(const in6_addr& address, std::uint32_t interface, std::uint16_t port) {
  Endpoint endpoint;
  endpoint.port = port;
  std::memcpy(endpoint.address.data(), &address, sizeof address);
  if (IN6_IS_ADDR_LINKLOCAL(&address)) endpoint.scope = interface;
  return endpoint;
}

template <class Info>
void writeControl(msghdr& header, detail::ControlBuffer& control, int level, int type, const Info& info) {
  header.msg_control = control.bytes.data();
  header.msg_controllen = CMSG_SPACE(sizeof info);
  cmsghdr* const message = CMSG_FIRSTHDR(&header);
  message->cmsg_level = level;
  message->cmsg_type = type;
  message->cmsg_len = CMSG_LEN(sizeof info);
  std::memcpy(CMSG_DATA(message), &info, sizeof info);
}

template <class Info>
Info readControl(cmsghdr* message) {
  Info info;
  std::memcpy(&info, CMSG_DATA(message), sizeof info);
  return info;
}

}  // namespace

// Sending.

UdpSendBatch::UdpSendBatch(bool six) : six_(six), slots_(std::make_unique<std::array<Slot, kUdpBatch>>()) {
  for (std::size_t i = 0; i < kUdpBatch; ++i) {
    Slot& slot = (*slots_)[i];
    slot.part.iov_base = slot.bytes.data();
    headers_[i].msg_hdr.msg_iov = &slot.part;
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_name = &slot.address;
  }
}

char* UdpSendBatch::nextPacket() {
  assert(!full());
  return (*slots_)[count_].bytes.data();
}

bool UdpSendBatch::add(const Path& path, std::string_view packet) {
  assert(!full() && packet.size() <= kMaxDatagram);
  if (!six_ && !path.remote.isIPv4()) return false;
  Slot& slot = (*slots_)[count_];
  msghdr& header = headers_[count_].msg_hdr;
  if (packet.data() != slot.bytes.data()) std::copy(packet.begin(), packet.end(), slot.bytes.begin());
  slot.part.iov_len = packet.size();
  slot.address = {};
  if (six_) {
    slot.address.six.sin6_family = AF_INET6;
    slot.address.six.sin6_port = htons(path.remote.port);
    slot.address.six.sin6_addr = sixOf(path.remote);
    slot.address.six.sin6_scope_id = path.remote.scope;
    header.msg_namelen = sizeof(sockaddr_in6);
  } else {
    slot.address.four.sin_family = AF_INET;
    slot.address.four.sin_port = htons(path.remote.port);
    slot.address.four.sin_addr = fourOf(path.remote);
    header.msg_namelen = sizeof(sockaddr_in);
  }
  writeSource(header, slot, path.local);
  ++count_;
  return true;
}

void UdpSendBatch::writeSource(msghdr& header, Slot& slot, const Endpoint& local) const {
  if (local.isAny()) {
    header.msg_control = nullptr;
    header.msg_controllen = 0;
  } else if (six_) {
    writeControl(header, slot.control, IPPROTO_IPV6, IPV6_PKTINFO,
                 in6_pktinfo{.ipi6_addr = sixOf(local), .ipi6_ifindex = local.scope});
  } else {
    writeControl(header, slot.control, IPPROTO_IP, IP_PKTINFO,
                 in_pktinfo{.ipi_ifindex = 0, .ipi_spec_dst = fourOf(local), .ipi_addr = {}});
  }
}

void UdpSendBatch::send(int descriptor, UdpCounters& counters) {
  bool refused = false;
  for (std::size_t next = 0; next < count_;) {
    const int taken =
        ::sendmmsg(descriptor, &headers_[next], static_cast<unsigned>(count_ - next), MSG_DONTWAIT);
    if (taken > 0) {
      next += static_cast<std::size_t>(taken);
      counters.sent += static_cast<std::uint64_t>(taken);
      refused = false;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS) {
      counters.dropped_full += count_ - next;
      break;
    } else if (errno == EINTR) {
      continue;
    } else if (errno == ECONNREFUSED && !refused) {
      refused = true;  // caused by an ICMP message about an earlier packet; this one was not sent yet
    } else {
      ++counters.send_errors;  // the error concerns only the call's first packet
      ++next;
      refused = false;
    }
  }
  count_ = 0;
}

// Receiving.

UdpReceiveBatch::UdpReceiveBatch(std::uint16_t local_port)
    : local_port_(local_port), slots_(std::make_unique<std::array<Slot, kUdpBatch>>()) {
  for (std::size_t i = 0; i < kUdpBatch; ++i) {
    Slot& slot = (*slots_)[i];
    slot.part = {slot.bytes.data(), slot.bytes.size()};
    headers_[i].msg_hdr.msg_iov = &slot.part;
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_name = &slot.address;
    headers_[i].msg_hdr.msg_control = slot.control.bytes.data();
  }
}

int UdpReceiveBatch::receive(int descriptor) {
  for (mmsghdr& header : headers_) {  // because the last recvmmsg() changed them
    header.msg_hdr.msg_namelen = sizeof(detail::SocketAddress);
    header.msg_hdr.msg_controllen = sizeof(detail::ControlBuffer);
    header.msg_hdr.msg_flags = 0;
  }
  const int count = ::recvmmsg(descriptor, headers_.data(), kUdpBatch, MSG_DONTWAIT, nullptr);
  return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK) ? 0 : count;
}

std::string_view UdpReceiveBatch::packet(int n) const {
  const auto index = static_cast<std::size_t>(n);
  if (tooLarge(n)) return {};
  return {(*slots_)[index].bytes.data(), headers_[index].msg_len};
}

bool UdpReceiveBatch::tooLarge(int n) const {
  return (headers_[static_cast<std::size_t>(n)].msg_hdr.msg_flags & MSG_TRUNC) != 0;
}

Path UdpReceiveBatch::path(int n) {
  const auto index = static_cast<std::size_t>(n);
  const detail::SocketAddress& from = (*slots_)[index].address;
  Path path;
  path.remote = from.generic.sa_family == AF_INET6
                    ? endpointOf(from.six.sin6_addr, from.six.sin6_scope_id, ntohs(from.six.sin6_port))
                    : endpointOf(from.four.sin_addr, ntohs(from.four.sin_port));
  path.local.port = local_port_;
  msghdr& header = headers_[index].msg_hdr;
  for (cmsghdr* message = CMSG_FIRSTHDR(&header); message; message = CMSG_NXTHDR(&header, message)) {
    if (message->cmsg_level == IPPROTO_IPV6 && message->cmsg_type == IPV6_PKTINFO) {
      const auto info = readControl<in6_pktinfo>(message);
      path.local = endpointOf(info.ipi6_addr, info.ipi6_ifindex, local_port_);
    } else if (message->cmsg_level == IPPROTO_IP && message->cmsg_type == IP_PKTINFO) {
      path.local = endpointOf(readControl<in_pktinfo>(message).ipi_addr, local_port_);
    }
  }
  return path;
}

}  // namespace naiad
