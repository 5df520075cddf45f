// A TLS stream on a TCP or Unix domain socket.
//
// OpenSSL itself reads from and writes to the socket, without a buffer between them. An idle connection holds
// none of OpenSSL's buffers either.
#pragma once

#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/SocketBio.h"
#include "shared/net/stream/StallTolerantTimer.h"
#include "shared/net/stream/TlsContext.h"

struct ssl_st;

namespace naiad {

class TlsStream : public ByteStream {
 public:
  /// Makes the stream of a client or a server, depending on the context. A client passes the server's name: a
  /// host name goes into the hello (SNI, RFC 6066 3), and a certificate verifies only for this name or
  /// address. Throws TlsError if out of memory, or if a client's `server_name` is invalid.
  TlsStream(Socket socket, std::shared_ptr<const TlsContext> context, const std::string& server_name = {},
            std::string peer = {});
  ~TlsStream() override;

  /// Continues the handshake; returns kDone when it is complete. Do not read, write or export secrets before.
  /// A server (TlsContext::forServer()) stops once with kWantsApproval when it has the client's whole hello,
  /// before it computes the answer, which takes a signature. The next call continues.
  Outcome handshake();
  bool isClient() const { return !context_->isServer(); }
  /// The reason for a failed handshake, as the end of a sentence ("it does not speak TLS").
  const std::string& problem() const { return problem_; }
  /// True if the peer closed the connection, or it broke.
  bool isDisconnected() const { return bio_.ended || bio_.failed; }
  /// Returns the facts that the handshake proved about the server; only for clients.
  std::optional<PeerIdentity> peerIdentity() const;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  /// Sends close_notify and the end of the TCP stream.
  Outcome end() override;
  bool hasBufferedInput() const override;
  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override;

 private:
  struct Free {
    void operator()(ssl_st* ssl) const;
  };
  void expect(const std::string& server_name);
  Outcome outcomeOf(int result);
  void explain();

  std::shared_ptr<const TlsContext> context_;
  SocketBio bio_;
  std::unique_ptr<ssl_st, Free> ssl_;
  std::string problem_;
  bool hello_approved_ = false;
  bool end_sent_ = false;
};

/// Completes a TLS handshake within a time limit, without blocking.
///
/// Each object makes one handshake. Make it with std::make_shared; it keeps itself alive while it runs.
///
/// Thread: the one that runs the socket's io_context, which must outlive it. Steps never wait; the longest
/// one, which signs or verifies, takes about 0.25 ms.
class TlsHandshake : public std::enable_shared_from_this<TlsHandshake> {
 public:
  enum class End {
    kDone,
    kTimedOut,
    kDisconnected,  ///< the other end disconnected, or the connection broke
    kFailed,        ///< no TLS 1.3, no common protocol, or a similar cause
  };
  /// `stream`: only with kDone. `problem`: with kDisconnected and kFailed, the reason as the end of a
  /// sentence.
  using Done = std::function<void(End end, std::unique_ptr<TlsStream> stream, const std::string& problem)>;

  explicit TlsHandshake(std::unique_ptr<TlsStream> stream);

  /// `timeout` covers the whole handshake, however slowly the bytes arrive. `done` is called once, from the
  /// event loop or readAhead(), unless cancelled. At a server (TlsContext::forServer()), `on_hello` is
  /// called once when the client's hello is complete, before the answer, which takes most of the CPU time of
  /// a handshake; it may cancel().
  void run(std::chrono::milliseconds timeout, Done done, std::function<void()> on_hello = nullptr);
  /// Restarts the timeout with this time.
  void setTimeout(std::chrono::milliseconds timeout);
  /// Reads the received bytes without waiting for the event loop.
  void readAhead();
  /// Disconnects; `done` will not be called.
  void cancel();

 private:
  void await(asio::ip::tcp::socket::wait_type readiness);
  void step();
  void finish(End end);

  std::unique_ptr<TlsStream> stream_;
  StallTolerantTimer timer_;
  Done done_;                       // empty: the handshake is over
  std::function<void()> on_hello_;  // empty: already called, or none was given
  std::uint64_t waits_ = 0;         // number of waits; only the newest continues the handshake
};

}  // namespace naiad
