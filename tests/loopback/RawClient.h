// A connection that sends whatever bytes a test wants, well-formed or not. Blocking, with deadlines.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <memory>
#include <optional>
#include <string>

#include "naiad.pb.h"
#include "shared/net/stream/SocketBio.h"

struct ssl_st;

namespace naiad::test {

class RawClient {
 public:
  enum class Line { kPlain, kTls };

  /// With TLS the handshake is done afterwards, unless the server has hung up in it.
  explicit RawClient(std::uint16_t port, Line line = Line::kPlain);
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// Send bytes as they are. Errors (the server hung up) are ignored.
  void sendBytes(const std::string& bytes);
  /// Send one frame around `payload`.
  void sendFrame(const std::string& payload);
  void send(const wire::ClientMessage& message) { sendFrame(message.SerializeAsString()); }
  /// A hello that the server accepts, unless changed by the caller.
  static wire::ClientMessage hello(const std::string& name);

  /// The next message from the server; nothing once it hung up (or after 30 s).
  std::optional<wire::ServerMessage> receive();
  /// Read until the server hangs up. False if it did not within 30 s.
  bool waitForHangup();
  /// Send no more; read until the server has taken in everything and hangs up. False after 30 s.
  bool finish();
  /// Hang up so that the server sees a reset, as if the process was killed.
  void reset();

 private:
  struct FreeTls {
    void operator()(ssl_st* tls) const;
  };

  std::optional<std::string> readExactly(std::size_t count);
  int transfer(bool out, char* bytes, std::size_t count);
  bool await(bool out);

  asio::io_context m_context;
  asio::ip::tcp::socket m_socket{m_context};
  SocketBio m_bio;
  std::unique_ptr<ssl_st, FreeTls> m_tls;  ///< null: plain
  bool m_timed_out = false;
};

}  // namespace naiad::test
