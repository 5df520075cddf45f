// A socket that datagrams of many peers come and go through, as the protocol code sees it.
//
// UDP (UdpSocket.h) and a network in virtual time (VirtualNetwork.h) stand behind it. It knows nothing of
// keys or sessions: whatever arrives is handed on, and may be forged.
#pragma once

#include <functional>
#include <string_view>

#include "shared/net/datagram/Path.h"

namespace naiad {

/// Never blocks. Not thread-safe: callbacks come on the thread that runs the socket's event loop.
class DatagramSocket {
 public:
  /// The view is valid during the call only. The callee may send, and may destroy the socket.
  using OnPacket = std::function<void(const Path& path, std::string_view packet)>;

  virtual ~DatagramSocket() = default;

  /// Begin to receive. Call once.
  virtual void start(OnPacket on_packet) = 0;
  /// Queue one packet of 1 … 1200 bytes (else std::length_error) for path.remote, to leave from path.local;
  /// any local address lets the system choose. A full batch leaves at once, the rest with flush().
  virtual void send(const Path& path, std::string_view packet) = 0;
  /// Where the next packet may be written, so that send() need not copy it: kMaxDatagram bytes, valid until
  /// the next call of send(), flush() or reopen(). Null if the socket has no such memory.
  virtual char* nextPacket() { return nullptr; }
  /// Send what is queued. What the system does not take at once is dropped, as any datagram may be.
  virtual void flush() = 0;
  /// Take another free port, as a client does when its network has changed. What is queued or was not read
  /// yet is lost. Throws ListenError (TcpListener.h); the socket then has no port, and this may be tried
  /// again.
  virtual void reopen() = 0;
  /// The address bound to and the port, also when any was asked for.
  virtual Endpoint localEndpoint() const = 0;
};

}  // namespace naiad
