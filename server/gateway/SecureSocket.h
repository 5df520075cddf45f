// A connected socket of Boost.Asio, with or without TLS, as the streams that Beast and Asio's composed
// operations want (AsyncReadStream and AsyncWriteStream).
//
// OpenSSL reads from and writes to the socket itself (SocketBio.h). boost::asio::ssl::stream would hold 68
// KiB of buffers for each connection; this one holds none while it is quiet.
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

/// The executor of everything in the gateway, by its type: calls through it are direct.
using GatewayExecutor = boost::asio::io_context::executor_type;

/// Thread: the one that runs the io_context. At most one read and one write are under way at a time; the
/// socket must stay where it is while one is.
class SecureSocket {
 public:
  using Socket = boost::asio::basic_stream_socket<boost::asio::generic::stream_protocol, GatewayExecutor>;
  using executor_type = GatewayExecutor;
  enum class Role { kClient, kServer };

  /// Takes a connected socket and makes it non-blocking. Without TLS until startTls().
  explicit SecureSocket(Socket socket);
  ~SecureSocket();
  SecureSocket(SecureSocket&&) noexcept;
  SecureSocket& operator=(SecureSocket&&) noexcept;

  /// TLS from now on; asyncHandshake() comes next. False if out of memory. A server refuses a hello of more
  /// than 4 KiB (SocketBio.h).
  bool startTls(ssl_ctx_st* context, Role role);
  bool hasTls() const { return m_tls != nullptr; }
  /// Under TLS: the other end has closed the connection, or it broke; as opposed to what it said being wrong.
  bool hasEnded() const;
  /// For a client after its handshake: the key that the other end proved to hold; nothing if it did not agree
  /// to `protocol` by ALPN.
  std::optional<Fingerprint> provenKey(std::string_view protocol) const;

  executor_type get_executor() { return m_socket.get_executor(); }
  Socket& socket() { return m_socket; }
  /// Has the kernel more than `limit` bytes that it did not send to the other end yet? No if it does not
  /// know. It is asked only if more than that was written since it was asked last.
  bool hasUnsent(std::size_t limit);

  /// Keep these bytes, and send them with the next flush(): behind the writes that are under way, before
  /// later ones, and never within one. So what others write on this socket (Beast's control frames) stays
  /// whole.
  void put(std::string_view bytes) { m_kept.append(bytes); }
  /// Bytes kept and not handed to the kernel yet.
  std::size_t keptBytes() const { return m_kept.size() - m_kept_begin; }
  /// Send what is kept, in one piece and as far as that goes without waiting; the rest is tried with the next
  /// write, or flush(). False if the connection has ended.
  bool flush();
  /// Tell the other end that nothing more comes, as far as that goes without waiting.
  void shutDownSend();
  /// End the connection at once. Operations under way fail. Harmless if it has ended.
  void close();

  /// Signature of the token: void(error_code). Bring TLS to the point where bytes can flow.
  template <class Token>
  auto asyncHandshake(Token&& token) {
    return start<void(error_code)>(Step<HandshakeTry>{*this, {}, m_is_server}, std::forward<Token>(token));
  }
  /// Signature: void(error_code). Send the end, and throw away what still comes, so that no reset overtakes
  /// what was sent last. Ends with the other end's, after kMaxDrained bytes, or by close().
  template <class Token>
  auto asyncDrain(Token&& token) {
    shutDownSend();
    return start<void(error_code)>(Step<DrainTry>{*this, {}, true}, std::forward<Token>(token));
  }
  /// Signature: void(error_code). Until the kernel holds so little that it takes more to send
  /// (TCP_NOTSENT_LOWAT).
  template <class Token>
  auto asyncWaitForRoom(Token&& token) {
    return m_socket.async_wait(Socket::wait_write, std::forward<Token>(token));
  }
  /// As Asio's streams have them; eof if the other end said that this was all, connection_reset if it went
  /// without saying so under TLS.
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
  /// What one attempt came to: with kDone an error or a number of bytes.
  struct Progress {
    Outcome outcome = Outcome::kDone;
    std::size_t bytes = 0;
    error_code error{};
  };

  static constexpr std::size_t kMaxDrained = std::size_t{256} * 1024;
  static constexpr std::size_t kFlatSize = std::size_t{16} * 1024;  // a TLS record
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
      if (!socket.hasTls()) return socket.judge(socket.writePlain(buffers));
      // One record of what lies in several places. A later attempt begins with the same bytes, as OpenSSL
      // wants.
      const std::size_t size =
          boost::asio::buffer_copy(boost::asio::buffer(flatBytes().data(), flatBytes().size()), buffers);
      return size == 0 ? Progress{} : socket.tryWriteTls(flatBytes().first(size));
    }
  };

  /// Tries, waits for the socket, tries again; completes never before the call that started it has returned.
  template <class Try>
  struct Step {
    SecureSocket& socket;
    Try attempt;
    bool waits_first;  // for input: most of the time there is none yet, and room for output is
    bool begun = false;
    Progress early{};     // what came of the first attempt,
    bool posted = false;  // which waits to be reported

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
  static Progress judge(std::pair<error_code, std::size_t> written);
  Progress tryHandshake();
  Progress tryRead(std::span<char> into);
  Progress tryWriteTls(std::span<const char> bytes);
  Progress tryFlush();
  Progress tryDrain(std::size_t& drained);
  Progress judgeTls(int result, std::size_t bytes);

  Socket m_socket;
  std::unique_ptr<Tls> m_tls;
  bool m_is_server = false;     // of TLS: it waits for the client's hello before OpenSSL takes memory
  bool m_is_mid_write = false;  // a part of a write was sent: its rest comes next
  std::string m_kept;
  std::size_t m_kept_begin = 0;              // of it, so much was sent
  std::size_t m_unsent_bound = kNeverAsked;  // no more than this is unsent
};

// What Beast's WebSockets ask of the stream below them: how it ends, in order and at once.
void beast_close_socket(SecureSocket& socket);
void teardown(boost::beast::role_type role, SecureSocket& socket, error_code& error);
template <class Handler>
void async_teardown(boost::beast::role_type, SecureSocket& socket, Handler&& handler) {
  socket.asyncDrain(std::forward<Handler>(handler));
}

}  // namespace naiad
