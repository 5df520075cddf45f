// Opens a connection to a host and port without blocking: TLS, or plain TCP on loopback.
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

/// Makes one attempt at a time; reusable after it ended, for a client that reconnects.
///
///   TcpConnector connector(context, {.receive_limit = kMaxServerFrame});
///   connector.connect("localhost", kDefaultPort, 5s, [&](auto channel, const std::string& error) { … });
///
/// With TLS it accepts any server that supports the protocol. In `done`, the caller must check peerIdentity()
/// before it starts the channel or sends on it.
///
/// Thread: the one that runs `context`, which must outlive the connector. The connector may be destroyed at
/// any time, even in its own callback; that cancels.
class TcpConnector {
 public:
  /// Receives a channel that is not started, and an empty `error`; or no channel and one sentence for people.
  using Done = std::function<void(std::unique_ptr<ReliableChannel> channel, const std::string& error)>;

  /// `tls`: TlsContext::forClient(); without it, plain TCP.
  explicit TcpConnector(asio::io_context& context, TcpOptions options = {},
                        std::shared_ptr<const TlsContext> tls = nullptr);
  ~TcpConnector();
  TcpConnector(const TcpConnector&) = delete;
  TcpConnector& operator=(const TcpConnector&) = delete;

  /// Resolves `host` (a name, or an IPv4 or IPv6 address without brackets) and tries its addresses in turn,
  /// each for its share of `timeout`, which covers the whole attempt. The next address is tried if one is
  /// silent or unreachable, not if a server fails the handshake. Without TLS, other machines are
  /// refused. `done` is called once, from the event loop, unless cancelled. Cancels a running attempt.
  void connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout, Done done);
  /// Like connect() above, with the known addresses of `host`.
  void connect(const std::string& host, const std::vector<asio::ip::tcp::endpoint>& endpoints,
               std::chrono::milliseconds timeout, Done done);

  /// Like connect(), through a visitors' socket of this machine (ProxyListener.h), for a player at
  /// `visitor`. `host` and `port` are the server's public address. Only with TLS.
  void connectFor(const asio::ip::tcp::endpoint& visitor, const std::string& socket, const std::string& host,
                  std::uint16_t port, std::chrono::milliseconds timeout, Done done);

  /// Restricts later attempts to addresses for which `is_allowed` returns true; a host without any such
  /// address is refused. Empty: all are allowed. Does not apply to connectFor().
  void restrict(std::function<bool(const asio::ip::address& address)> is_allowed) {
    is_allowed_ = std::move(is_allowed);
  }

  /// Facts about the server of the newest channel, valid from the call of `done` to the next connect() or
  /// cancel(). nullopt without TLS.
  const std::optional<PeerIdentity>& peerIdentity() const { return peer_identity_; }

  /// True if, in the newest attempt, the server closed the connection or it broke during the handshake.
  /// Servers do this if too many come from one address; a retry may succeed.
  bool closedDuringHandshake() const { return closed_during_handshake_; }

  /// Ends the attempt, if there is one; `done` will not be called. (A name look-up continues on its own
  /// thread until the resolver's timeout; the io_context's destructor waits for it.)
  void cancel();

 private:
  asio::io_context& context_;
  TcpOptions options_;
  std::shared_ptr<const TlsContext> tls_;
  std::shared_ptr<StreamAttempt> attempt_;
  std::optional<PeerIdentity> peer_identity_;
  bool closed_during_handshake_ = false;
  std::function<bool(const asio::ip::address& address)> is_allowed_;

  StreamAttempt& begin(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                       Done done);
};

}  // namespace naiad
