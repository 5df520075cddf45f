// Real sockets on this machine, without fixed ports or sleeping.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/v6_only.hpp>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <utility>

#include "TestIdentity.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad::test {

using asio::ip::tcp;

/// Runs the event loop until `condition` returns true; false after 30 s.
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

/// Runs all handlers that are ready now.
inline void runReady(asio::io_context& context) {
  context.restart();
  context.poll();
}

struct SocketPair {
  tcp::socket near;
  tcp::socket far;
};

/// Returns two connected sockets. Throws std::system_error if the address does not exist on this machine.
inline SocketPair connectedSockets(asio::io_context& context, const std::string& address = "127.0.0.1") {
  tcp::acceptor acceptor(context, tcp::endpoint(asio::ip::make_address(address), 0));
  tcp::socket near(context);
  near.connect(acceptor.local_endpoint());
  return {std::move(near), acceptor.accept()};
}

/// Whether channels run over plain TCP or over TLS.
enum class Kind { kPlain, kTls };

inline std::string nameOf(const testing::TestParamInfo<Kind>& info) {
  return info.param == Kind::kTls ? "Tls" : "Plain";
}

/// Two connected streams that are ready for bytes.
struct StreamPair {
  std::unique_ptr<ByteStream> near;
  std::unique_ptr<ByteStream> far;
};

inline StreamPair connectedStreams(asio::io_context& context, Kind kind) {
  SocketPair sockets = connectedSockets(context);
  if (kind == Kind::kPlain) {
    return {std::make_unique<PlainStream>(std::move(sockets.near)),
            std::make_unique<PlainStream>(std::move(sockets.far))};
  }
  auto client = std::make_unique<TlsStream>(std::move(sockets.near), testClientContext(), "naiad.test");
  auto server = std::make_unique<TlsStream>(std::move(sockets.far), testServerContext());
  bool client_done = false, server_done = false;
  while (!client_done || !server_done) {
    const auto step = [](TlsStream& stream) {
      const auto outcome = stream.handshake();
      if (outcome >= ByteStream::Outcome::kEnd) throw std::runtime_error(stream.problem());
      return outcome == ByteStream::Outcome::kDone;
    };
    client_done = client_done || step(*client);
    server_done = server_done || step(*server);
  }
  return {std::move(client), std::move(server)};
}

/// Both ends of a channel after login.
struct ChannelPair {
  explicit ChannelPair(asio::io_context& context, Kind kind, TcpOptions options = {.receive_limit = 0xffff}) {
    StreamPair streams = connectedStreams(context, kind);
    near = makeTcpChannel(std::move(streams.near), options);
    far = makeTcpChannel(std::move(streams.far), options);
  }

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

/// Prevents this process from opening descriptors during its lifetime.
class NoDescriptorsLeft {
 public:
  NoDescriptorsLeft() {
    getrlimit(RLIMIT_NOFILE, &m_before);
    rlimit none = m_before;
    none.rlim_cur = 0;
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptorsLeft() { setrlimit(RLIMIT_NOFILE, &m_before); }
  NoDescriptorsLeft(const NoDescriptorsLeft&) = delete;
  NoDescriptorsLeft& operator=(const NoDescriptorsLeft&) = delete;

 private:
  rlimit m_before{};
};

}  // namespace naiad::test
