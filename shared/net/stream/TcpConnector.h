// Opens a connection to a host and port, without blocking: TLS, or plain TCP on loopback.
#pragma once

#include <asio/ip/tcp.hpp>
#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shared/net/base/Channel.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

class StreamAttempt;

/// One attempt at a time; may be used again after it ended, for a client that reconnects.
///
///   TcpConnector connector(context, {.receive_limit = kMaxServerFrame});
///   connector.connect("localhost", kDefaultPort, 5s, [&](auto channel, const std::string& error) { … });
///
/// With TLS it takes any server that can do the protocol. In `done` the caller judges peerFacts(), before it
/// starts the channel or sends anything on it.
///
/// Thread: the one that runs `context`, which must outlive the connector. The connector may be destroyed at
/// any time, in its own callback too; that cancels.
class TcpConnector {
 public:
  /// Either a channel, not started yet, and an empty `error`; or no channel and one sentence for people.
  using Done = std::function<void(std::unique_ptr<ReliableChannel> channel, const std::string& error)>;

  /// `tls`: TlsContext::forClient(); without it, plain TCP.
  explicit TcpConnector(asio::io_context& context, TcpOptions options = {},
                        std::shared_ptr<const TlsContext> tls = nullptr);
  ~TcpConnector();
  TcpConnector(const TcpConnector&) = delete;
  TcpConnector& operator=(const TcpConnector&) = delete;

  /// Resolve `host` (a name, or an IPv4 or IPv6 address without brackets) and try its addresses in turn, each
  /// for its share of `timeout`, which covers everything. The next address is tried when one is silent or
  /// cannot be reached, not when a server there fails the handshake. Without TLS, names that do not lead to
  /// this machine are refused. `done` is called once, from the event loop, unless cancelled. Cancels an
  /// attempt under way.
  void connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout, Done done);
  /// The same with addresses that are known already. `host`: what they are addresses of.
  void connect(const std::string& host, const std::vector<asio::ip::tcp::endpoint>& endpoints,
               std::chrono::milliseconds timeout, Done done);

  /// The same by way of a visitors' socket of this machine (VisitorsListener.h), for a player at `visitor`.
  /// `host` and `port` are what the server is called. With TLS only.
  void connectFor(const asio::ip::tcp::endpoint& visitor, const std::string& socket, const std::string& host,
                  std::uint16_t port, std::chrono::milliseconds timeout, Done done);

  /// From now on only addresses are connected to of which `is_allowed` says so; a host that has none is as
  /// one that cannot be reached. Empty: all.
  void restrict(std::function<bool(const asio::ip::address& address)> is_allowed) {
    is_allowed_ = std::move(is_allowed);
  }

  /// About the server behind the newest channel given out: set from before `done` is called until the next
  /// connect() or cancel(). Nothing without TLS.
  const std::optional<PeerFacts>& peerFacts() const { return peer_facts_; }

  /// The newest attempt ended because the server hung up on it, or the line broke, during the handshake: so
  /// it does where too many come from one place, and another attempt may do.
  bool wasHungUpOn() const { return was_hung_up_on_; }

  /// Give up; `done` will not be called. Harmless when nothing is under way. (A name look-up runs on in its
  /// own thread until the resolver's time-out; destroying the io_context waits for it.)
  void cancel();

 private:
  asio::io_context& context_;
  TcpOptions options_;
  std::shared_ptr<const TlsContext> tls_;
  std::shared_ptr<StreamAttempt> attempt_;
  std::optional<PeerFacts> peer_facts_;
  bool was_hung_up_on_ = false;
  std::function<bool(const asio::ip::address& address)> is_allowed_;

  StreamAttempt& begin(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                       Done done);
};

}  // namespace naiad
