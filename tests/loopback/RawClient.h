// A blocking connection that sends arbitrary bytes, well-formed or not. With timeouts.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <memory>
#include <optional>
#include <string>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/SocketBio.h"

struct ssl_st;

namespace naiad::test {

class RawClient {
 public:
  enum class Line { kPlain, kTls };

  /// Connects; with kTls, also does the handshake. The server may close the connection during it.
  explicit RawClient(std::uint16_t port, Line line = Line::kPlain);
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// Sends these bytes. Errors, for example because the server closed the connection, are ignored.
  void sendBytes(const std::string& bytes);
  /// Sends a frame with this payload.
  void sendFrame(const std::string& payload);
  void send(const wire::ClientMessage& message) { sendFrame(message.SerializeAsString()); }
  /// Returns a hello that the server accepts.
  static wire::ClientMessage hello(const std::string& name) {
    wire::ClientMessage message;
    message.mutable_hello()->set_magic(kHelloMagic);
    message.mutable_hello()->set_protocol(kProtocolVersion);
    message.mutable_hello()->set_player_name(name);
    return message;
  }

  /// Returns the server's next message; nullopt if the server closed the connection, or after 30 s.
  std::optional<wire::ServerMessage> receive();
  /// Reads until the server closes the connection. False after 30 s.
  bool waitForHangup();
  /// Ends this side of the stream, then reads until the server, which has read everything, closes it. False
  /// after 30 s.
  bool finish();
  /// Closes the connection with a reset, as if the process was killed.
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
  std::unique_ptr<ssl_st, FreeTls> m_tls;  ///< null for plain TCP
  bool m_timed_out = false;
};

}  // namespace naiad::test
