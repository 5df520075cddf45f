// Waits for connections on one address and port: TLS, or plain TCP on loopback.
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

/// Why a connection was hung up on before TLS.
enum class StreamRefusal {
  kBanned,      ///< by TlsListening::is_banned
  kTooOften,    ///< by TlsListening::take_handshake or has_handshake
  kFull,        ///< none was silent, and there was no place
  kPrefixFull,  ///< the prefix has its share of the places
};

/// How a listener does TLS.
struct TlsListening {
  std::shared_ptr<const TlsContext> context;  ///< TlsContext::forServer()
  /// From accepting a connection to the end of its handshake. While more than half of max_half_open are under
  /// way, those that come get a quarter of it until their hello is complete, and half of it from then on.
  std::chrono::milliseconds handshake_timeout{5000};
  /// Connections between these two, in all and from one IPv4 address or IPv6 /64 (HalfOpenLimit.h). Beyond
  /// that, silent ones are ended for new ones.
  std::size_t max_half_open = 256;
  std::size_t max_half_open_per_prefix = 64;
  /// The connections of such prefixes have places of their own, this many, which no other ones can take. May
  /// be empty. Called from the listener's event loop, once for each connection.
  std::function<bool(const AddressPrefix& prefix)> is_known = nullptr;
  std::size_t max_half_open_known = 256;
  /// May a connection of this prefix, whose hello is complete and has a place, have an answer to it? That
  /// takes a signature. Asked once for each of these. May be empty. Called from the listener's event loop.
  std::function<bool(const AddressPrefix& prefix)> take_handshake = nullptr;
  /// Would that be so now? Asked for each connection that comes. May be empty.
  std::function<bool(const AddressPrefix& prefix)> has_handshake = nullptr;
  /// Connections of such addresses are hung up on before anything else: not a byte is sent to them. May be
  /// empty. Called from the listener's event loop, once for each connection.
  std::function<bool(const asio::ip::address& address)> is_banned = nullptr;
  /// Hears of each connection that was refused. May be empty. Called from the listener's event loop.
  std::function<void(const asio::ip::tcp::endpoint& peer, StreamRefusal why)> on_refused = nullptr;
  /// A connection that says nothing is left in the kernel for so long (TCP_DEFER_ACCEPT). 0: it is not.
  std::chrono::seconds defer_accept{1};
};

/// A listener could not be made. what() is one sentence for people: "Port 9876 on 127.0.0.1 is in use …".
class ListenError : public std::runtime_error {
 public:
  ListenError(const std::string& sentence, std::error_code code)
      : std::runtime_error(sentence), code_(code) {}
  /// The cause, e.g. std::errc::address_in_use; std::errc::invalid_argument for an address refused here.
  std::error_code code() const { return code_; }

 private:
  std::error_code code_;
};

/// Accepts until closed or destroyed. Running out of descriptors or memory does not end it: it waits 100 ms
/// and tries again, while the connections wait in the kernel's backlog.
///
/// With TLS, handshakes run side by side, and a connection is given out when its own is done: in the order in
/// which they finish. A slow one delays no other.
///
/// Thread: the one that runs `context`, which must outlive the listener. The listener may be destroyed at
/// any time, in its own callback too. Channels it gave out do not depend on it.
class TcpListener {
 public:
  /// A connection is ready for frames. The channel is not started yet; dropping it hangs up.
  using OnChannel = std::function<void(std::unique_ptr<ReliableChannel> channel)>;

  /// What became of connections so far.
  struct Counters {
    std::uint64_t failed_accepts = 0;       ///< out of descriptors, …: put off
    std::uint64_t handshakes = 0;           ///< TLS: done, given out
    std::uint64_t handshakes_failed = 0;    ///< TLS: no TLS 1.3, no common protocol, hung up …
    std::uint64_t handshakes_late = 0;      ///< TLS: not done in time
    std::uint64_t half_open_ended = 0;      ///< TLS: silent, while another one needed the place
    std::uint64_t refused_half_open = 0;    ///< TLS: none was silent, and there was no place
    std::uint64_t refused_from_prefix = 0;  ///< TLS: the prefix has its share of the places
    std::uint64_t refused_too_often = 0;    ///< TLS: by TlsListening::take_handshake or has_handshake
    std::uint64_t refused_banned = 0;       ///< TLS: by TlsListening::is_banned
  };

  /// Listens from now on; `on_channel` is called from the event loop. `address`: numeric, IPv4 or IPv6;
  /// without `tls` loopback only ("127.0.0.1", "::1"). "::" listens on all of IPv4 as well. `port`: 0 takes
  /// any free one. SO_REUSEADDR is set, so a restart need not wait for old connections to time out. Throws
  /// ListenError.
  TcpListener(asio::io_context& context, const std::string& address, std::uint16_t port, OnChannel on_channel,
              TcpOptions options = {}, TlsListening tls = {});
  /// The same with a TCP socket that listens already, which is the listener's from now on.
  TcpListener(asio::io_context& context, int listening_socket, OnChannel on_channel, TcpOptions options,
              TlsListening tls);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// The port listened on, also when 0 was asked for.
  std::uint16_t port() const;
  /// "127.0.0.1:40000" or "[::1]:40000", for logs.
  std::string address() const;
  const Counters& counters() const;
  /// Counters::failed_accepts.
  std::uint64_t failedAccepts() const { return counters().failed_accepts; }
  /// Handshakes under way.
  std::size_t halfOpen() const;

  /// Go on with a connection that came otherwise (VisitorsListener.h) as with one that was accepted here from
  /// `peer`. With TLS only; ignored after close().
  void adopt(asio::generic::stream_protocol::socket socket, const asio::ip::tcp::endpoint& peer);

  /// Handshakes that begin from now on are made with this context; where there was none, nothing changes.
  void setTls(std::shared_ptr<const TlsContext> context);

  /// Stop listening; no callback after this. Connections not accepted yet are reset by the kernel, handshakes
  /// under way are broken off.
  void close();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
