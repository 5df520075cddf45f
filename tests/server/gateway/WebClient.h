// A browser's connection that sends whatever bytes a test wants: HTTP, WebSocket frames, or neither.
// Blocking, with deadlines; plain TCP.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "naiad.pb.h"

namespace naiad::test {

struct HttpReply {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

/// One frame of a WebSocket (RFC 6455 5.2).
struct WebFrame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping, 10 pong
  std::string payload;

  /// Of a close frame; 1005 if it has none.
  int closeCode() const;
};

class WebClient {
 public:
  /// From this loopback address; any address of 127.0.0.0/8 is one. `receive_buffer`: of the kernel, in
  /// bytes; 0: its own.
  explicit WebClient(std::uint16_t port, const std::string& from = "127.0.0.1", int receive_buffer = 0);

  /// Errors (the other end hung up) are ignored.
  void send(std::string_view bytes);
  /// "GET PATH" with the Host that belongs to the port, and these further lines.
  void get(const std::string& path, const std::string& lines = "", const std::string& method = "GET");
  /// The next answer; nothing if the connection ended, or after 30 s. `has_body`: not to HEAD.
  std::optional<HttpReply> reply(bool has_body = true);
  std::optional<HttpReply> ask(const std::string& path, const std::string& lines = "") {
    get(path, lines);
    return reply();
  }

  /// The request of a WebSocket; lines in it may be replaced by others of the same name, or left out
  /// ("Name:").
  void requestPlay(const std::string& changes = "");
  /// Open a WebSocket as the page does. False if the answer is another.
  bool play();
  static std::string frameBytes(int opcode, std::string_view payload, bool is_last = true,
                                bool is_masked = true);
  /// One frame, masked as browsers do it.
  void sendFrame(int opcode, std::string_view payload, bool is_last = true, bool is_masked = true);
  void sendMessage(const wire::ClientMessage& message) { sendFrame(2, message.SerializeAsString()); }
  /// The next frame; nothing if the connection ended, or after 30 s.
  std::optional<WebFrame> frame();
  /// The next binary message; pings are answered. Nothing if the WebSocket was closed.
  std::optional<wire::ServerMessage> message();
  /// Read until it is closed: the code, 0 if there was no close frame, -1 after 30 s.
  int waitForClose();
  /// Send a hello, and wait for the welcome.
  bool join(const std::string& name);
  static wire::ClientMessage hello(const std::string& name);

  /// Read until the other end hangs up. False after 30 s.
  bool waitForHangup();
  /// Has the other end hung up, as far as is known now? Throws away what came before that.
  bool isHungUp();
  /// Take at most so many bytes of what has come; how many.
  std::size_t takeSome(std::size_t most);
  /// What was read and not used yet.
  std::string& unread() { return m_unread; }
  /// A whole frame in unread(), taken out of it; nothing if there is none.
  std::optional<WebFrame> takeFrame();

 private:
  bool readMore();
  bool await(short events);

  asio::io_context m_context;
  asio::ip::tcp::socket m_socket{m_context};
  std::string m_host;
  std::string m_unread;
  bool m_timed_out = false;
};

}  // namespace naiad::test
