// Accepts connections on one address and port: TLS, or plain TCP on loopback.
#pragma once

#include <asio/generic/stream_protocol.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/Channel.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

/// The reason why a connection was dropped before TLS.
enum class StreamRefusal {
  kBanned,      ///< is_banned() refused it
  kTooOften,    ///< try_handshake() or can_handshake() refused it
  kFull,        ///< no free place, and none of the connections was silent
  kPrefixFull,  ///< the prefix has used up its share of the places
};

/// The TLS options of a listener. Its functions may be empty, and are called from the listener's event loop.
struct TlsListenerOptions {
  std::shared_ptr<const TlsContext> context;  ///< TlsContext::forServer()
  /// Time limit from accepting a connection to the end of its handshake. While more than half of the places
  /// are taken, new connections get a quarter of it until their hello is complete, then half of it.
  std::chrono::milliseconds handshake_timeout{5000};
  /// Limits of half-open connections, in all and from one IPv4 address or IPv6 /64 (HalfOpenLimit.h). When
  /// they are reached, silent connections are ended to make room for new ones.
  std::size_t max_half_open = 256;
  std::size_t max_half_open_per_prefix = 64;
  /// True for prefixes whose connections have places of their own, max_half_open_known, that no others can
  /// take. Called once per connection.
  std::function<bool(const AddressPrefix& prefix)> is_known = nullptr;
  std::size_t max_half_open_known = 256;
  /// Returns true, and counts it, if the complete hello of a connection of this prefix may be answered, which
  /// costs a signature. Called once per complete hello of a connection that has a place.
  std::function<bool(const AddressPrefix& prefix)> try_handshake = nullptr;
  /// Returns the value that try_handshake() would return now, without counting. Called once per connection.
  std::function<bool(const AddressPrefix& prefix)> can_handshake = nullptr;
  /// True for addresses whose connections are dropped at once, without sending them a byte. Called once per
  /// connection.
  std::function<bool(const asio::ip::address& address)> is_banned = nullptr;
  std::function<void(const asio::ip::tcp::endpoint& peer, StreamRefusal why)> on_refused = nullptr;
  /// Time for which a silent connection is left in the kernel (TCP_DEFER_ACCEPT). 0: none.
  std::chrono::seconds defer_accept{1};
};

/// A listener cannot be created. what() is one sentence for people: "Port 9876 on 127.0.0.1 is in use …".
class ListenError : public std::runtime_error {
 public:
  ListenError(const std::string& sentence, std::error_code code)
      : std::runtime_error(sentence), code_(code) {}
  /// The cause, e.g. std::errc::address_in_use; std::errc::invalid_argument for an address refused here.
  std::error_code code() const { return code_; }

 private:
  std::error_code code_;
};

/// Accepts until closed or destroyed. If an accept fails, usually without free descriptors or memory, it
/// retries every 100 ms; the connections wait in the kernel's backlog.
///
/// TLS handshakes run concurrently; connections are delivered as they finish. A slow one delays no other.
///
/// Thread: the one that runs `context`, which must outlive the listener. The listener may be destroyed at any
/// time, even in its own callback. Its channels do not depend on it.
class TcpListener {
 public:
  /// Receives a connection that is ready for frames. The channel is not started; destroying it disconnects.
  using OnChannel = std::function<void(std::unique_ptr<ReliableChannel> channel)>;

  struct Counters {
    std::uint64_t failed_accepts = 0;       ///< failed accepts, for example without descriptors; retried
    std::uint64_t handshakes = 0;           ///< TLS: completed, and the channel was delivered
    std::uint64_t handshakes_failed = 0;    ///< TLS: for example no TLS 1.3, no common protocol, disconnected
    std::uint64_t handshakes_late = 0;      ///< TLS: not done in time
    std::uint64_t half_open_ended = 0;      ///< TLS: silent ones, ended because another one needed the place
    std::uint64_t refused_half_open = 0;    ///< TLS: no free place, and none of the connections was silent
    std::uint64_t refused_from_prefix = 0;  ///< TLS: the prefix has used up its share of the places
    std::uint64_t refused_too_often = 0;    ///< TLS: try_handshake() or can_handshake() refused it
    std::uint64_t refused_banned = 0;       ///< TLS: is_banned() refused it
  };

  /// Starts to listen; `on_channel` is called from the event loop. `address`: numeric, IPv4 or IPv6; only
  /// loopback without `tls` ("127.0.0.1", "::1"). "::" also listens on IPv4. `port`: 0 takes any free one.
  /// Sets SO_REUSEADDR, so a restart need not wait until old connections time out. Throws ListenError.
  TcpListener(asio::io_context& context, const std::string& address, std::uint16_t port, OnChannel on_channel,
              TcpOptions options = {}, TlsListenerOptions tls = {});
  /// Like the other constructor, with a TCP socket that already listens; the listener takes ownership.
  TcpListener(asio::io_context& context, int listening_socket, OnChannel on_channel, TcpOptions options,
              TlsListenerOptions tls);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// The actual port, even if 0 was requested.
  std::uint16_t port() const;
  /// "127.0.0.1:40000" or "[::1]:40000", for logs.
  std::string address() const;
  const Counters& counters() const;
  std::uint64_t failedAccepts() const { return counters().failed_accepts; }
  /// The number of running handshakes.
  std::size_t halfOpen() const;

  /// Handles a connection from elsewhere (ProxyListener.h) like one accepted here from `peer`. Only with
  /// TLS; ignored after close().
  void adopt(asio::generic::stream_protocol::socket socket, const asio::ip::tcp::endpoint& peer);

  /// Uses this context for later handshakes. Does nothing if it is null or the listener has no TLS.
  void setTls(std::shared_ptr<const TlsContext> context);

  /// Stops listening; no callback runs after this. The kernel resets connections not accepted yet, and
  /// running handshakes are aborted.
  void close();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
