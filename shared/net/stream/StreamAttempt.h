// Opens one stream to a host and port without blocking: resolves the name, connects, and does the TLS
// handshake.
#pragma once

#include <asio/ip/tcp.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/StallTolerantTimer.h"
#include "shared/net/stream/TlsContext.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad {

/// A stream, or the reason why it could not be opened.
struct StreamResult {
  enum class End {
    kOpen,
    kNotFound,      ///< The resolver has no address for the host.
    kNotAllowed,    ///< StreamTarget::is_allowed refused the addresses.
    kOtherMachine,  ///< The host is not this machine, and TLS is off. `detail`: its address.
    kRefused,       ///< Nothing listens at the last address.
    kUnreachable,   ///< The last address cannot be reached.
    kHandshake,     ///< The TLS handshake failed.
    kTimedOut,
    kUnusable,  ///< The host's name or the visitors' socket cannot be used. `detail`: one sentence.
  };
  End end = End::kOpen;
  std::string detail = {};                         ///< the reason, usually the end of a sentence
  bool closed_in_handshake = false;                ///< the connection was closed or broke in the handshake
  std::unique_ptr<ByteStream> stream = {};         ///< set with kOpen
  std::optional<PeerIdentity> peer_identity = {};  ///< set with kOpen and TLS
};

struct StreamTarget {
  std::string host;  ///< a name, or an IPv4 or IPv6 address without brackets
  std::uint16_t port = 0;
  std::shared_ptr<const TlsContext> tls = {};  ///< null: plain TCP, to loopback addresses only
  /// True for addresses that may be used; empty: all.
  std::function<bool(const asio::ip::address& address)> is_allowed = {};

  /// Returns "127.0.0.1:9876" or "[::1]:9876".
  std::string text() const;
};

/// Each object makes one attempt. Make it with std::make_shared; it keeps itself alive while it runs.
///
/// Tries the addresses in turn, each for its share of `timeout`, which covers the whole attempt. The next
/// address is tried if one is silent or unreachable, not if the handshake with a server fails.
///
/// Thread: the one that runs `context`, which must outlive the attempt. Asio resolves names on its own
/// thread; the io_context's destructor waits for it.
class StreamAttempt : public std::enable_shared_from_this<StreamAttempt> {
 public:
  using Done = std::function<void(StreamResult result)>;

  /// `done` is called once, from the event loop, unless the attempt is cancelled.
  StreamAttempt(asio::io_context& context, StreamTarget target, std::chrono::milliseconds timeout, Done done);

  /// Resolves the host's name and connects. Call exactly one of resolve(), connect() and
  /// connectThroughProxy(), once.
  void resolve();
  /// Skips the resolver: `endpoints` are the addresses of the host.
  void connect(const std::vector<asio::ip::tcp::endpoint>& endpoints);
  /// Connects through a visitors' socket (ProxyListener.h) for a player at `visitor`. Only with TLS.
  void connectThroughProxy(const std::string& path, const asio::ip::tcp::endpoint& visitor);

  /// Ends the attempt; `done` will not be called.
  void cancel();

 private:
  using End = StreamResult::End;

  void limit();
  void onResolved(const std::error_code& error, const asio::ip::tcp::resolver::results_type& results);
  void choose(const std::vector<asio::ip::tcp::endpoint>& addresses);
  void tryNext();
  void onConnected(const std::error_code& error);
  void onProxyConnected(const std::error_code& error, const std::string& path,
                        const asio::ip::tcp::endpoint& visitor);
  void startHandshake(ByteStream::Socket connected);
  void onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream, const std::string& problem);
  void finish(StreamResult result);
  void fail(End end, const std::string& detail, bool closed_in_handshake = false);
  void disconnect();

  asio::io_context& context_;
  StreamTarget target_;
  std::chrono::milliseconds timeout_;
  Done done_;  // empty: this attempt is over
  asio::ip::tcp::resolver resolver_;
  asio::ip::tcp::socket socket_;
  asio::local::stream_protocol::socket proxy_socket_;  // used by connectThroughProxy() instead of `socket_`
  StallTolerantTimer timer_;
  StallTolerantTimer share_;  // limits the time for the current address
  std::shared_ptr<TlsHandshake> handshake_;
  std::vector<asio::ip::tcp::endpoint> endpoints_;
  std::size_t turn_ = 0;  // endpoints_[turn_ - 1] is being tried
  End last_end_ = End::kUnreachable;
  std::string last_detail_;
};

}  // namespace naiad
