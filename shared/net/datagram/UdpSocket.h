// UDP: one socket for all peers of a server, or for the server of a client.
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
  /// Numeric, IPv4 or IPv6. "0.0.0.0" or "::" hears every address of this machine.
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0 takes any free one
  bool v6_only = true;     ///< false: "::" hears IPv4, too
  /// Bytes asked of the kernel for what waits to be read, and to be sent; it may grant less.
  int buffer = 4 * 1024 * 1024;
  /// A UDP socket that is bound already, to `address` and `port`; it is the UdpSocket's from now on. Below 0:
  /// none.
  int inherited = -1;
};

/// Packets are never fragmented, on this machine or on the way. Up to 256 are read before other things in the
/// event loop have their turn; errors that ICMP reports are counted and change nothing.
///
/// Thread: the one that runs `context`, which must outlive the socket.
class UdpSocket : public DatagramSocket {
 public:
  /// Binds, or takes over what is bound. Throws ListenError.
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
