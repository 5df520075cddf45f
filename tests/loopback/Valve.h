// A client's UDP socket with an obstacle: datagrams vanish, are delayed, or come from another port.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shared/net/datagram/UdpSocket.h"

namespace naiad::test {

/// Settings and counters of the obstacle. They may be changed at any time. Must outlive the socket.
struct Valve {
  bool up = true;                      ///< datagrams of the client reach the server
  bool down = true;                    ///< datagrams from the server reach the client
  std::chrono::milliseconds delay{0};  ///< delay added in each direction
  std::uint16_t server_port = 0;  ///< port to which the client's datagrams are sent instead; 0: unchanged
  std::vector<std::string> seen;  ///< datagrams that the client sent, whether or not they were passed on
  DatagramSocket* p_socket = nullptr;  ///< the newest socket

  /// Sends from another port from now on, like a NAT that forgets a mapping.
  void rebind() { p_socket->reopen(); }
};

/// Returns a function for SessionOptions::open_socket that opens sockets with this valve.
std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> through(asio::io_context& context,
                                                                               std::shared_ptr<Valve> valve);

}  // namespace naiad::test
