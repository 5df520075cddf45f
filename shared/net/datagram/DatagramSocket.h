// A socket for the datagrams of many peers, as the protocol code sees it.
//
// Implemented by UDP (UdpSocket.h) and by a network in virtual time (VirtualNetwork.h). It knows nothing of
// keys or sessions: packets that it delivers may be forged.
#pragma once

#include <functional>
#include <string_view>

#include "shared/net/datagram/Path.h"

namespace naiad {

/// Never blocks. Not thread-safe: callbacks run on the thread that runs the socket's event loop.
class DatagramSocket {
 public:
  /// Receives a packet; the view is valid only during the call. May send, and may destroy the socket.
  using OnPacket = std::function<void(const Path& path, std::string_view packet)>;

  virtual ~DatagramSocket() = default;

  /// Begins to receive. Call once.
  virtual void start(OnPacket on_packet) = 0;
  /// Queues one packet of 1 … 1200 bytes (else std::length_error) to path.remote, from path.local; if
  /// path.local.isAny(), the system chooses the source. A full batch is sent at once, others by flush().
  virtual void send(const Path& path, std::string_view packet) = 0;
  /// Returns memory for the next packet, so that send() need not copy it: kMaxDatagram bytes, valid until the
  /// next call of send(), flush() or reopen(). Null if the socket has no such memory.
  virtual char* nextPacket() { return nullptr; }
  /// Sends the queued packets. Those that the system does not accept at once are dropped.
  virtual void flush() = 0;
  /// Changes to another free port, as a client does after its network changed. Queued and unread packets are
  /// lost. Throws ListenError (TcpListener.h); then the socket has no port, and reopen() may be called again.
  virtual void reopen() = 0;
  /// Returns the bound address and the actual port, even if port 0 was requested.
  virtual Endpoint localEndpoint() const = 0;
};

}  // namespace naiad
