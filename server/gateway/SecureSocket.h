// A connected Boost.Asio socket with or without TLS, which models AsyncReadStream and AsyncWriteStream for
// Beast and for Asio's composed operations.
//
// OpenSSL reads from and writes to the socket itself (SocketBio.h). boost::asio::ssl::stream would hold 68
// KiB of buffers per connection; this class holds none while the connection is idle.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/role.hpp>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/stream/Fingerprint.h"

struct ssl_ctx_st;

namespace naiad {

using boost::system::error_code;

/// The executor of the gateway. Using the concrete type avoids the virtual calls of any_io_executor.
using GatewayExecutor = boost::asio::io_context::executor_type;

/// Use on the thread that runs the io_context. At most one read and one write may be pending. The object must
/// not be moved while an operation is pending.
class SecureSocket {
 public:
  using Socket = boost::asio::basic_stream_socket<boost::asio::generic::stream_protocol, GatewayExecutor>;
  using executor_type = GatewayExecutor;
  enum class Role { kClient, kServer };

  /// Takes a connected socket and makes it non-blocking. Uses no TLS until startTls().
  explicit SecureSocket(Socket socket);
  ~SecureSocket();
  SecureSocket(SecureSocket&&) noexcept;
  SecureSocket& operator=(SecureSocket&&) noexcept;

  /// Switches to TLS; call asyncHandshake() next. Returns false if out of memory. A server rejects a client
  /// hello of more than 4 KiB (SocketBio.h).
  bool startTls(ssl_ctx_st* context, Role role);
  bool hasTls() const { return m_tls != nullptr; }
  /// True with TLS if the peer closed the connection or it broke; false after a TLS error.
  bool hasEnded() const;
  /// Returns the key that the server proved to have, for a client after the handshake. Returns nullopt if
  /// the server did not agree to `protocol` by ALPN.
  std::optional<Fingerprint> provenKey(std::string_view protocol) const;

  executor_type get_executor() { return m_socket.get_executor(); }
  Socket& socket() { return m_socket; }
  /// True if the kernel has more than `limit` bytes that it has not sent to the peer; false if the kernel
  /// cannot tell. Asks the kernel only if its last answer plus the bytes written since then exceed `limit`.
  bool hasUnsent(std::size_t limit);

  /// Queues these bytes for the next flush(). They are sent after pending writes and before later ones, never
  /// in the middle of one, so other writes on this socket (Beast's control frames) stay intact.
  void put(std::string_view bytes) { m_queued.append(bytes); }
  /// Number of queued bytes that the kernel does not have yet.
  std::size_t queuedBytes() const { return m_queued.size() - m_queued_begin; }
  /// Sends the queued bytes as far as possible without waiting. The next write or flush() sends the rest.
  /// Returns false if the connection has ended.
  bool flush();
  /// Tells the peer that no more data follows, if that is possible without waiting.
  void shutDownSend();
  /// Ends the connection at once. Pending operations fail. Does nothing if it has ended.
  void close();

  /// Performs the TLS handshake. Signature of the token: void(error_code).
  template <class Token>
  auto asyncHandshake(Token&& token) {
    return start<void(error_code)>(Step<HandshakeTry>{*this, {}, m_is_server}, std::forward<Token>(token));
  }
  /// Calls shutDownSend() and discards input, so that no reset overtakes the last data sent. Ends when the
  /// peer closes, after kMaxDrained bytes, or at close(). Signature of the token: void(error_code).
  template <class Token>
  auto asyncDrain(Token&& token) {
    shutDownSend();
    return start<void(error_code)>(Step<DrainTry>{*this, {}, true}, std::forward<Token>(token));
  }
  /// Waits until the kernel accepts more data (TCP_NOTSENT_LOWAT). Signature of the token: void(error_code).
  template <class Token>
  auto asyncWaitWritable(Token&& token) {
    return m_socket.async_wait(Socket::wait_write, std::forward<Token>(token));
  }
  /// Like the functions of these names of Asio's streams. A read ends with eof after an orderly shutdown by
  /// the peer, and with connection_reset if the peer left without a TLS shutdown.
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return start<void(error_code, std::size_t)>(Step<ReadTry<Buffers>>{*this, {buffers}, !holdsInput()},
                                                std::forward<Token>(token));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return start<void(error_code, std::size_t)>(Step<WriteTry<Buffers>>{*this, {buffers}, false},
                                                std::forward<Token>(token));
  }

 private:
  struct Tls;
  enum class Outcome { kDone, kWantsRead, kWantsWrite };
  /// The result of an attempt. With kDone, it has an error or a number of bytes.
  struct Progress {
    Outcome outcome = Outcome::kDone;
    std::size_t bytes = 0;
    error_code error{};
  };

  static constexpr std::size_t kMaxDrained = std::size_t{256} * 1024;
  static constexpr std::size_t kFlatSize = std::size_t{16} * 1024;  // maximum data of a TLS record
  static constexpr std::size_t kNeverAsked = std::size_t{1} << 40;

  struct HandshakeTry {
    static constexpr bool kCounts = false;
    Progress operator()(SecureSocket& socket) { return socket.tryHandshake(); }
  };
  struct DrainTry {
    static constexpr bool kCounts = false;
    std::size_t drained = 0;
    Progress operator()(SecureSocket& socket) { return socket.tryDrain(drained); }
  };
  template <class Buffers>
  struct ReadTry {
    static constexpr bool kCounts = true;
    Buffers buffers;
    Progress operator()(SecureSocket& socket) {
      for (const boost::asio::mutable_buffer buffer : range(buffers)) {
        if (buffer.size() > 0) return socket.tryRead({static_cast<char*>(buffer.data()), buffer.size()});
      }
      return {};
    }
  };
  template <class Buffers>
  struct WriteTry {
    static constexpr bool kCounts = true;
    Buffers buffers;
    Progress operator()(SecureSocket& socket) {
      if (!socket.m_is_mid_write) {
        const Progress before = socket.tryFlush();
        if (before.outcome != Outcome::kDone || before.error) return before;
      }
      const Progress progress = write(socket);
      const bool is_whole = progress.outcome == Outcome::kDone &&
                            (progress.error || progress.bytes == boost::asio::buffer_size(buffers));
      socket.m_is_mid_write = !is_whole;
      return progress;
    }
    Progress write(SecureSocket& socket) {
      if (!socket.hasTls()) return socket.toProgress(socket.writePlain(buffers));
      // Copies the buffers together, to make one record of them. A retry copies equal bytes, as OpenSSL
      // requires.
      const std::size_t size =
          boost::asio::buffer_copy(boost::asio::buffer(flatBytes().data(), flatBytes().size()), buffers);
      return size == 0 ? Progress{} : socket.tryWriteTls(flatBytes().first(size));
    }
  };

  /// An asynchronous operation: attempts it, waits until the socket is ready, and attempts it again. Never
  /// completes before the initiating call has returned.
  template <class Try>
  struct Step {
    SecureSocket& socket;
    Try attempt;
    bool waits_first;  // true for reads, because usually no input is there yet; false for writes
    bool begun = false;
    Progress early{};     // result of the first attempt
    bool posted = false;  // the next call reports `early`

    template <class Self>
    void operator()(Self& self, error_code failed = {}) {
      if (failed) return finish(self, {Outcome::kDone, 0, failed});
      if (posted) return finish(self, early);
      const bool is_first = !begun;
      begun = true;
      if (is_first && waits_first) {
        return socket.m_socket.async_wait(Socket::wait_read, std::move(self));
      }
      const Progress progress = attempt(socket);
      if (progress.outcome != Outcome::kDone) {
        return socket.m_socket.async_wait(
            progress.outcome == Outcome::kWantsWrite ? Socket::wait_write : Socket::wait_read,
            std::move(self));
      }
      if (!is_first) return finish(self, progress);
      early = progress;
      posted = true;
      const auto executor = socket.get_executor();
      boost::asio::post(executor, std::move(self));
    }
    template <class Self>
    static void finish(Self& self, const Progress& progress) {
      if constexpr (Try::kCounts) {
        self.complete(progress.error, progress.bytes);
      } else {
        self.complete(progress.error);
      }
    }
  };
  template <class Signature, class Composed, class Token>
  auto start(Composed composed, Token&& token) {
    return boost::asio::async_compose<Token, Signature>(std::move(composed), token, m_socket);
  }

  template <class Buffers>
  static auto range(const Buffers& buffers) {
    struct Range {
      decltype(boost::asio::buffer_sequence_begin(buffers)) first;
      decltype(boost::asio::buffer_sequence_end(buffers)) last;
      auto begin() const { return first; }
      auto end() const { return last; }
    };
    return Range{boost::asio::buffer_sequence_begin(buffers), boost::asio::buffer_sequence_end(buffers)};
  }
  template <class Buffers>
  std::pair<error_code, std::size_t> writePlain(const Buffers& buffers) {
    error_code error;
    const std::size_t size = m_socket.write_some(buffers, error);
    m_unsent_bound += size;
    return {error, size};
  }

  static std::span<char> flatBytes();
  bool holdsInput() const;
  static Progress toProgress(std::pair<error_code, std::size_t> written);
  Progress tryHandshake();
  Progress tryRead(std::span<char> into);
  Progress tryWriteTls(std::span<const char> bytes);
  Progress tryFlush();
  Progress tryDrain(std::size_t& drained);
  Progress toTlsProgress(int result, std::size_t bytes);

  Socket m_socket;
  std::unique_ptr<Tls> m_tls;
  bool m_is_server = false;     // TLS server: wait for the client's hello before OpenSSL allocates memory
  bool m_is_mid_write = false;  // a part of a write was sent; its rest must be sent next
  std::string m_queued;
  std::size_t m_queued_begin = 0;            // bytes of m_queued that were sent
  std::size_t m_unsent_bound = kNeverAsked;  // upper bound of the kernel's unsent bytes
};

// Functions that Beast's WebSockets require of the stream below them: immediate and orderly close.
void beast_close_socket(SecureSocket& socket);
void teardown(boost::beast::role_type role, SecureSocket& socket, error_code& error);
template <class Handler>
void async_teardown(boost::beast::role_type, SecureSocket& socket, Handler&& handler) {
  socket.asyncDrain(std::forward<Handler>(handler));
}

}  // namespace naiad
