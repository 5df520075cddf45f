// A listener that does TLS, and its clients.
#pragma once

#include <gtest/gtest.h>

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

struct TlsFixture : testing::Test {
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
  /// Connect as a client does, and wait until both ends have a channel.
  void join(const std::string& host = "127.0.0.1") {
    calls = 0;
    const std::size_t before = accepted.size();
    connector.connect(host, listener->port(), std::chrono::seconds(20), done());
    EXPECT_TRUE(runUntil(context, [&] { return calls > 0 && (!channel || accepted.size() > before); }));
    EXPECT_TRUE(channel) << error;
  }
  const TcpListener::Counters& counters() const { return listener->counters(); }

  asio::io_context context;
  TlsListening tls;
  std::unique_ptr<TcpListener> listener;
  std::vector<std::unique_ptr<ReliableChannel>> accepted;
  TcpConnector connector{context, {.receive_limit = kMaxServerFrame}, testClientContext()};
  std::unique_ptr<ReliableChannel> channel;
  std::string error;
  int calls = 0;
};

}  // namespace naiad::test
