// A channel whose peer is a bare stream that the test plays by hand, plain or in TLS.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {

struct TcpFixture : testing::TestWithParam<Kind> {
  void connect(TcpOptions options) {
    makeChannel(options);
    channel->start(recorder.callbacks());
  }
  /// Makes the channel without starting it.
  void makeChannel(TcpOptions options) {
    StreamPair streams = connectedStreams(context, GetParam());
    peer = std::move(streams.far);
    channel = makeTcpChannel(std::move(streams.near), options);
  }
  bool encrypted() const { return GetParam() == Kind::kTls; }

  void peerSends(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto [outcome, size] = peer->write(bytes);
      ASSERT_TRUE(outcome == ByteStream::Outcome::kDone || outcome == ByteStream::Outcome::kWantsWrite);
      bytes.remove_prefix(size);
    }
  }
  /// Reads and discards all bytes that have arrived for the peer. Returns the outcome that ended it.
  ByteStream::Outcome peerReads() {
    std::array<char, 16384> sink;
    for (;;) {
      const auto outcome = peer->read(sink).outcome;
      if (outcome != ByteStream::Outcome::kDone) return outcome;
    }
  }
  /// Ends the stream in order (with TLS: close_notify), then closes the socket.
  void peerEnds() {
    ASSERT_EQ(peer->end(), ByteStream::Outcome::kDone);
    peer->socket().close();
  }
  /// Closes the socket like a killed program, without an orderly end (with TLS: no close_notify).
  void peerVanishes() { peer->socket().close(); }
  void peerResets() {
    peer->socket().set_option(tcp::socket::linger(true, 0));
    peer->socket().close();
  }
  bool runUntilClosed() {
    return runUntil(context, [&] { return recorder.closed.has_value(); });
  }
  /// Sends until bytes stay unsent because the peer does not read.
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
  std::unique_ptr<ByteStream> peer;
  Recorder recorder;
  std::unique_ptr<ReliableChannel> channel;
};

}  // namespace naiad::test
