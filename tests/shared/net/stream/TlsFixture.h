// A TLS listener and its clients.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "RawTls.h"
#include "shared/net/stream/TcpConnector.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {

/// Holds the result of a connector.
struct ConnectFixture : testing::Test {
  TcpConnector::Done done() {
    return [this](std::unique_ptr<ReliableChannel> made, const std::string& sentence) {
      channel = std::move(made);
      error = sentence;
      ++calls;
    };
  }
  bool runUntilDone() {
    return runUntil(context, [&] { return calls > 0; });
  }

  asio::io_context context;
  std::unique_ptr<ReliableChannel> channel;
  std::string error;
  int calls = 0;
};

struct TlsFixture : ConnectFixture {
  /// Accepts silent connections at once, so that tests need not wait for the kernel.
  TlsFixture() { tls.defer_accept = std::chrono::seconds(0); }
  void listen(const std::string& address = "127.0.0.1") {
    if (!tls.context) tls.context = testServerContext();
    listener = std::make_unique<TcpListener>(
        context, address, 0, [this](auto made) { accepted.push_back(std::move(made)); },
        TcpOptions{.receive_limit = kMaxServerFrame}, tls);
  }
  tcp::socket knock(const std::string& address = "127.0.0.1") {
    tcp::socket socket(context);
    socket.connect({asio::ip::make_address(address), listener->port()});
    return socket;
  }
  /// Connects from this address in 127/8.
  tcp::socket knockFrom(const std::string& own) {
    tcp::socket socket(context, tcp::endpoint(asio::ip::make_address(own), 0));
    socket.connect({asio::ip::make_address("127.0.0.1"), listener->port()});
    return socket;
  }
  std::vector<tcp::socket> knockTimes(int times) {
    std::vector<tcp::socket> sockets;
    for (int i = 0; i < times; ++i) sockets.push_back(knock());
    return sockets;
  }
  /// True if the server has closed the connection.
  static bool isOver(tcp::socket& socket) {
    std::error_code error;
    std::array<char, 4096> in;
    socket.non_blocking(true);
    while (socket.read_some(asio::buffer(in), error) > 0) {
    }
    return error != asio::error::would_block;
  }
  /// Connects like a client and waits until both ends have a channel.
  void join(const std::string& host = "127.0.0.1") {
    calls = 0;
    const std::size_t before = accepted.size();
    connector.connect(host, listener->port(), std::chrono::seconds(20), done());
    EXPECT_TRUE(runUntil(context, [&] { return calls > 0 && (!channel || accepted.size() > before); }));
    EXPECT_TRUE(channel) << error;
  }
  const TcpListener::Counters& counters() const { return listener->counters(); }

  TlsListenerOptions tls;
  std::unique_ptr<TcpListener> listener;
  std::vector<std::unique_ptr<ReliableChannel>> accepted;
  TcpConnector connector{context, {.receive_limit = kMaxServerFrame}, testClientContext()};
};

}  // namespace naiad::test
