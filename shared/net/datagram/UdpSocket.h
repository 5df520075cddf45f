// A UDP socket: a server's for all its clients, or a client's for its server.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/UdpBatch.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

struct UdpOptions {
  /// Numeric IPv4 or IPv6 address. "0.0.0.0" or "::" receives on every address of this machine.
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free port
  bool v6_only = true;     ///< false: "::" also receives IPv4
  /// Requested size of the kernel's receive and send buffers, in bytes; the kernel may grant less.
  int buffer = 4 * 1024 * 1024;
  /// A UDP socket already bound to `address` and `port`; the UdpSocket takes ownership. Negative: none.
  int inherited = -1;
};

/// Packets are never fragmented, on this machine or on the way. Reads up to 256 before other handlers of the
/// event loop run. Errors reported by ICMP are counted or ignored; two in a row while sending drop a packet.
///
/// Thread: the one that runs `context`, which must outlive the socket.
class UdpSocket : public DatagramSocket {
 public:
  /// Binds, or takes over an inherited socket. Throws ListenError.
  UdpSocket(asio::io_context& context, UdpOptions options);
  ~UdpSocket() override;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  void start(OnPacket on_packet) override;
  void send(const Path& path, std::string_view packet) override;
  char* nextPacket() override;
  void flush() override;
  void reopen() override;
  Endpoint localEndpoint() const override;

  const UdpCounters& counters() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
