// Real sockets on this machine, without fixed ports or sleeping.
#pragma once

#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/v6_only.hpp>
#include <chrono>
#include <utility>

#include "Limits.h"
#include "TcpChannel.h"

namespace naiad::test {

using asio::ip::tcp;

/// Run the event loop until `condition` holds; false if it does not within a generous time.
template <class Condition>
bool runUntil(asio::io_context& context, Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    if (context.stopped()) context.restart();
    context.run_one_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Run everything that is ready now.
inline void runReady(asio::io_context& context) {
  context.restart();
  context.poll();
}

struct SocketPair {
  tcp::socket near;
  tcp::socket far;
};

/// Two connected sockets; throws std::system_error if the address does not exist here.
inline SocketPair connectedSockets(asio::io_context& context, const std::string& address = "127.0.0.1") {
  tcp::acceptor acceptor(context, tcp::endpoint(asio::ip::make_address(address), 0));
  tcp::socket near(context);
  near.connect(acceptor.local_endpoint());
  return {std::move(near), acceptor.accept()};
}

/// Two ends as client and server see them after login.
struct ChannelPair {
  explicit ChannelPair(asio::io_context& context, TcpOptions options = generous(),
                       const std::string& address = "127.0.0.1") {
    SocketPair sockets = connectedSockets(context, address);
    near = makeTcpChannel(std::move(sockets.near), options);
    far = makeTcpChannel(std::move(sockets.far), options);
  }
  static TcpOptions generous() { return {.receive_limit = 0xffff}; }

  std::unique_ptr<ReliableChannel> near;
  std::unique_ptr<ReliableChannel> far;
};

inline bool haveIPv6Loopback() {
  asio::io_context context;
  try {
    connectedSockets(context, "::1");
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

}  // namespace naiad::test
