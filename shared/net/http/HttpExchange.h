// One HTTP/1.1 request to a web server and its answer, on its own connection, without blocking.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/net/http/HttpResponseReader.h"
#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/StallTolerantTimer.h"
#include "shared/net/stream/StreamAttempt.h"

namespace naiad {

struct HttpRequest {
  std::string method = "GET";
  std::string target = "/";                                      ///< path and query
  std::string host;                                              ///< value of the Host header
  std::vector<std::pair<std::string, std::string>> fields = {};  ///< must not contain CR or LF; not checked
  std::string body = {};  ///< the body; if not empty, Content-Length is added

  std::string text() const;
};

/// Each object makes one exchange. Make it with std::make_shared; it keeps itself alive while it runs.
///
/// If TLS is used, nothing is sent to a server with an invalid certificate (StreamTarget::tls is
/// TlsContext::forWebClient()). Without TLS, only loopback addresses are connected to.
///
/// Thread: the one that runs `context`, which must outlive the exchange. The io_context's destructor waits
/// until a pending name lookup ends (StreamAttempt.h).
class HttpExchange : public std::enable_shared_from_this<HttpExchange> {
 public:
  enum class End {
    kAnswered,      ///< answer() is complete; its status may be any.
    kNotFound,      ///< The host has no address.
    kOtherMachine,  ///< The host is not this machine, and there is no TLS, or is_allowed() refused it.
    kUnreachable,
    kUntrusted,       ///< The TLS handshake failed (invalid certificate), or the host's name is invalid.
    kConnectionLost,  ///< The connection broke while the request was sent.
    kBadAnswer,       ///< The answer is truncated, malformed or has too long a head.
    kTooLong,         ///< The body has more bytes than allowed.
    kStopped,         ///< The body's handler returned false.
    kTimedOut,
  };
  struct Result {
    End end = End::kAnswered;
    std::string detail;  ///< reason in a few words, not from the peer; empty if `end` is enough
  };
  using Done = std::function<void(const Result& result)>;
  /// Receives a piece, perhaps empty, of the body of an answer with status 200. Returns false if the rest is
  /// not needed.
  using BodyHandler = std::function<bool(std::string_view piece)>;

  explicit HttpExchange(asio::io_context& context, const HttpLimits& limits = {});

  /// Sends `request` to `server`. `done` is called once, from the event loop, unless cancelled. `timeout`
  /// covers the whole exchange. With `on_body`, the body is not stored but passed on as it arrives, a status
  /// other than 200 is a bad answer, and `timeout` covers only the time until the request is sent, not the
  /// answer.
  void run(const StreamTarget& server, const HttpRequest& request, std::chrono::milliseconds timeout,
           Done done, BodyHandler on_body = nullptr);
  /// Ends the exchange; `done` will not be called.
  void cancel();

  const HttpResponseReader& answer() const { return m_reader; }
  /// After status 101, returns the stream, which now speaks the requested protocol. Call in `done`.
  std::unique_ptr<ByteStream> releaseStream() { return std::move(m_stream); }
  /// Returns the received bytes after the answer: after status 101, the first ones of the requested protocol.
  const std::string& bytesBehind() const { return m_behind; }

 private:
  using Outcome = ByteStream::Outcome;

  void onStream(StreamResult result);
  void write();
  void read();
  void handleBytes(std::string_view bytes);
  void checkProgress();
  void await(Outcome wish, void (HttpExchange::*step)());
  void finish(End end, const std::string& detail = {});
  void stop();

  asio::io_context& m_context;
  HttpResponseReader m_reader;
  StallTolerantTimer m_timer;
  std::shared_ptr<StreamAttempt> m_attempt;
  std::unique_ptr<ByteStream> m_stream;
  std::string m_request;
  std::size_t m_written = 0;
  std::string m_behind;
  BodyHandler m_on_body;
  Done m_done;  // empty: the exchange is over
};

}  // namespace naiad
