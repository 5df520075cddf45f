// WebSockets (RFC 6455) to a gateway for browsers, by Boost.Beast.
//
// Boost.Beast works on Boost's Asio, everything else here on the standalone one, and no source can include
// both. So a thread of its own runs these sockets, and this header names neither.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "client/trust/GatewayAddress.h"

namespace naiad {

/// The thread that runs the sockets. Ends them all when it is destroyed.
class WebSocketThread {
 public:
  struct Loop;

  WebSocketThread();
  ~WebSocketThread();
  WebSocketThread(const WebSocketThread&) = delete;
  WebSocketThread& operator=(const WebSocketThread&) = delete;

  /// The one that all sockets of the process have in common; it ends with the last of those who hold it.
  static std::shared_ptr<WebSocketThread> common();

  Loop& loop() { return *m_loop; }

 private:
  std::unique_ptr<Loop> m_loop;
};

/// One WebSocket to the path /play with the subprotocol naiad.1: each binary message is a frame. All members
/// may be called from any thread.
class WebSocket {
 public:
  /// Called on the sockets' thread, and never after close() was called there.
  struct Events {
    std::function<void(std::string error)> on_open;  ///< once; empty: it is open, else a sentence for people
    std::function<void(std::string frame)> on_frame;
    std::function<void(bool in_order)> on_closed;  ///< by the gateway, once it was open
  };

  /// Begin to open it. A certificate must be good in the eyes of the system's trust store; without encryption
  /// only addresses of this machine are connected to.
  static std::shared_ptr<WebSocket> open(WebSocketThread& thread, const GatewayAddress& address,
                                         Events events);
  virtual ~WebSocket() = default;

  virtual void send(std::string frame) = 0;
  /// Close it, after what was sent.
  virtual void close() = 0;
  /// Bytes that were given to send() and have not been handed to the system yet.
  virtual std::size_t unsentBytes() const = 0;
};

}  // namespace naiad
