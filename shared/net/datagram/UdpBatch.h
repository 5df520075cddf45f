// Batches of packets to and from the kernel, many per call (sendmmsg, recvmmsg). Each packet has the local
// address that it leaves from or was sent to (IP_PKTINFO, IPV6_PKTINFO). The buffers are allocated once.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "shared/net/datagram/Path.h"
#include "shared/net/datagram/SealedHeader.h"

namespace naiad {

/// Counters of a UDP socket's packets, including lost ones.
struct UdpCounters {
  std::uint64_t sent = 0;            ///< packets accepted by the kernel
  std::uint64_t received = 0;        ///< packets passed on
  std::uint64_t dropped_full = 0;    ///< not sent: the kernel's buffer was full
  std::uint64_t send_errors = 0;     ///< not sent: no route, address gone, too large for the link etc.
  std::uint64_t receive_errors = 0;  ///< ICMP and other errors reported instead of a packet, ignored
  std::uint64_t too_large = 0;       ///< received, longer than 1200 bytes, ignored
};

inline constexpr std::size_t kUdpBatch = 64;  // maximum packets per call

namespace detail {

union SocketAddress {
  sockaddr generic;
  sockaddr_in four;
  sockaddr_in6 six;
};

struct ControlBuffer {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in6_pktinfo))> bytes;
};

}  // namespace detail

/// A batch of packets to send. `six`: for an IPv6 socket, which sends to IPv4 addresses in their mapped form.
class UdpSendBatch {
 public:
  explicit UdpSendBatch(bool six);

  bool full() const { return count_ == kUdpBatch; }
  /// Returns memory for the next packet, kMaxDatagram bytes, which add() need not copy. Call only if the
  /// batch is not full.
  char* nextPacket();
  /// Adds a packet; false if a socket of this family cannot reach the address. Call only if not full.
  bool add(const Path& path, std::string_view packet);
  /// Passes all packets to the kernel without blocking. The batch is empty afterwards, even after errors.
  void send(int descriptor, UdpCounters& counters);
  void clear() { count_ = 0; }

 private:
  struct Slot {
    std::array<char, kMaxDatagram> bytes;
    detail::SocketAddress address;
    detail::ControlBuffer control;
    iovec part;
  };
  void writeSource(msghdr& header, Slot& slot, const Endpoint& local) const;

  bool six_;
  std::size_t count_ = 0;
  std::unique_ptr<std::array<Slot, kUdpBatch>> slots_;
  std::array<mmsghdr, kUdpBatch> headers_{};
};

class UdpReceiveBatch {
 public:
  explicit UdpReceiveBatch(std::uint16_t local_port);

  /// Receives at most kUdpBatch waiting packets. Returns their number; 0 if none waits; −1 on errors (errno).
  int receive(int descriptor);
  /// Returns packet `n` of the batch, counted from 0; empty if it was longer than 1200 bytes (tooLarge()).
  std::string_view packet(int n) const;
  Path path(int n);
  bool tooLarge(int n) const;

 private:
  struct Slot {
    std::array<char, kMaxDatagram> bytes;
    detail::SocketAddress address;
    detail::ControlBuffer control;
    iovec part;
  };
  std::uint16_t local_port_;
  std::unique_ptr<std::array<Slot, kUdpBatch>> slots_;
  std::array<mmsghdr, kUdpBatch> headers_{};
};

}  // namespace naiad
