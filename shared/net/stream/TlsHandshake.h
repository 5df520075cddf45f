// Brings a TLS connection to the point where bytes can flow, within a deadline, without blocking.
#pragma once

#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "shared/net/stream/PatientTimer.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad {

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
