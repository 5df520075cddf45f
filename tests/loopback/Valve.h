// A client's UDP socket with something in the way: datagrams vanish, are late, or come from another port.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "shared/net/datagram/UdpSocket.h"

namespace naiad::test {

/// What becomes of the datagrams; may be changed at any time. Outlives the socket.
struct Valve {
  bool up = true;                      ///< what is sent reaches the server
  bool down = true;                    ///< what it sends reaches the client
  std::chrono::milliseconds delay{0};  ///< in each direction
  std::uint16_t server_port = 0;       ///< where they really go; 0: where they should
  std::uint64_t sent = 0;              ///< let through
  std::uint64_t arrived = 0;           ///< likewise
  DatagramSocket* p_socket = nullptr;  ///< the newest one

  /// They come from another port from now on, without notice, as when a NAT forgets.
  void rebind() { p_socket->reopen(); }
};

/// For SessionOptions::open_socket.
std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> through(asio::io_context& context,
                                                                               std::shared_ptr<Valve> valve);

}  // namespace naiad::test
