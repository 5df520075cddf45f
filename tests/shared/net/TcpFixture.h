// A channel whose peer is a bare socket that the test plays by hand.
#pragma once

#include <gtest/gtest.h>

#include <asio/write.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "Loopback.h"
#include "Recorder.h"

namespace naiad::test {

struct TcpFixture : testing::Test {
  void connect(TcpOptions options) {
    SocketPair sockets = connectedSockets(context);
    peer = std::move(sockets.far);
    channel = makeTcpChannel(std::move(sockets.near), options);
    channel->start(recorder.callbacks());
  }
  void peerSends(std::string_view bytes) { asio::write(peer, asio::buffer(bytes)); }
  bool runUntilClosed() {
    return runUntil(context, [&] { return recorder.closed.has_value(); });
  }
  /// Send until bytes stay behind, for the peer does not read.
  void fillUp() {
    const std::string frame(16000, 'x');
    for (int quiet = 0; quiet < 3;) {
      const std::size_t before = channel->unsentBytes();
      if (before < 100'000) channel->send(frame);
      runReady(context);
      quiet = channel->unsentBytes() >= 100'000 && channel->unsentBytes() == before ? quiet + 1 : 0;
    }
  }

  asio::io_context context;
  tcp::socket peer{context};
  Recorder recorder;
  std::unique_ptr<ReliableChannel> channel;
};

}  // namespace naiad::test
