// Bytes in TLS on a TCP socket.
//
// OpenSSL reads from and writes to the socket itself: there is no buffer between the two, and an idle
// connection holds none of OpenSSL's either.
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
#include "shared/net/stream/PatientTimer.h"
#include "shared/net/stream/SocketBio.h"
#include "shared/net/stream/TlsContext.h"

struct ssl_st;

namespace naiad {

class TlsStream : public ByteStream {
 public:
  /// Client or server, as the context is. A client names the server it wants: a name goes into the hello
  /// (SNI, RFC 6066 3) and a name or address is what the certificate must be for. Throws TlsError if out of
  /// memory.
  TlsStream(Socket socket, std::shared_ptr<const TlsContext> context, const std::string& server_name = {},
            std::string peer = {});
  ~TlsStream() override;

  /// Go on with the handshake; kDone when it is complete. Before that, nothing else may be called. A server
  /// stops once with kWantsJudgement when the client's hello has come, all of it: nothing of the answer has
  /// been calculated, which takes a signature. The next call goes on.
  Outcome handshake();
  /// A client does.
  bool speaksFirst() const { return !context_->isServer(); }
  /// After a handshake that failed: why, as the end of a sentence ("it does not speak TLS").
  const std::string& problem() const { return problem_; }
  /// The peer closed the connection, or it broke.
  bool isHungUp() const { return bio_.ended || bio_.failed; }
  /// For a client after the handshake: what it proved about the server.
  std::optional<PeerFacts> peerFacts() const;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  /// close_notify, and the end of the TCP stream.
  Outcome end() override;
  bool holdsInput() const override;
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
  bool hello_judged_ = false;
  bool end_sent_ = false;
};

/// Brings a TLS connection to the point where bytes can flow, within a deadline, without blocking.
///
/// One handshake, one use. Make it with std::make_shared; it keeps itself alive while it runs.
///
/// Thread: the one that runs the socket's io_context, which must outlive it. A step of it never waits; the
/// longest, which signs or verifies, takes about a quarter of a millisecond.
class TlsHandshake : public std::enable_shared_from_this<TlsHandshake> {
 public:
  enum class End {
    kDone,
    kTimedOut,
    kHungUp,  ///< by the other side, or the connection broke
    kFailed,  ///< no TLS 1.3, no common protocol …
  };
  /// `stream`: with kDone only. `problem`: with kHungUp and kFailed, why, as the end of a sentence.
  using Done = std::function<void(End end, std::unique_ptr<TlsStream> stream, const std::string& problem)>;

  explicit TlsHandshake(std::unique_ptr<TlsStream> stream);

  /// `timeout` covers all of it, however the bytes dribble in. `done` is called once, from the event loop or
  /// readAhead(), unless cancelled. `on_hello`, at a server: the same when the client's hello is complete,
  /// and before its answer is calculated, which takes most of the time of a handshake; it may cancel().
  void run(std::chrono::milliseconds timeout, Done done, std::function<void()> on_hello = nullptr);
  /// From now on there is this much time.
  void setTimeout(std::chrono::milliseconds timeout);
  /// Take in what has come, without waiting for the event loop.
  void readAhead();
  /// Hang up; `done` will not be called.
  void cancel();

 private:
  void await(asio::ip::tcp::socket::wait_type readiness);
  void step();
  void finish(End end);

  std::unique_ptr<TlsStream> stream_;
  PatientTimer timer_;
  Done done_;                       // empty: over
  std::function<void()> on_hello_;  // empty: called, or not wanted
  std::uint64_t waits_ = 0;         // of which the newest counts
};

}  // namespace naiad
