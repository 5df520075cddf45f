// A browser's connection that can send any bytes: HTTP, WebSocket frames, or neither. Uses plain TCP. Its
// functions block, with timeouts.
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

  /// Returns the code of a close frame; 1005 if it has none.
  int closeCode() const;
};

class WebClient {
 public:
  /// Connects from a loopback address (any in 127.0.0.0/8). `receive_buffer`: size of the kernel's receive
  /// buffer in bytes; 0: default.
  explicit WebClient(std::uint16_t port, const std::string& from = "127.0.0.1", int receive_buffer = 0);

  /// Sends bytes. Ignores errors, such as a connection closed by the other end.
  void send(std::string_view bytes);
  /// Sends "GET PATH" with the right Host for the port and these additional header lines.
  void get(const std::string& path, const std::string& lines = "", const std::string& method = "GET");
  /// Returns the next reply; nullopt if the connection ended, or after 30 s. `has_body`: false for HEAD.
  std::optional<HttpReply> reply(bool has_body = true);
  std::optional<HttpReply> ask(const std::string& path, const std::string& lines = "") {
    get(path, lines);
    return reply();
  }

  /// Sends a WebSocket request. `changes` replaces headers of the same name; "Name:" removes one.
  void requestPlay(const std::string& changes = "");
  /// Opens a WebSocket as the page does. Returns false if the server refuses it.
  bool play();
  static std::string frameBytes(int opcode, std::string_view payload, bool is_last = true,
                                bool is_masked = true);
  /// Sends one frame, masked as browsers do.
  void sendFrame(int opcode, std::string_view payload, bool is_last = true, bool is_masked = true);
  void sendMessage(const wire::ClientMessage& message) { sendFrame(2, message.SerializeAsString()); }
  /// Returns the next frame; nullopt if the connection ended, or after 30 s.
  std::optional<WebFrame> frame();
  /// Returns the next binary message; answers pings before it. Returns nullopt if the WebSocket was closed.
  std::optional<wire::ServerMessage> message();
  /// Reads until the WebSocket is closed. Returns the close code, 0 without close frame, -1 after 30 s.
  int waitForClose();
  /// Sends a hello and waits for the welcome.
  bool join(const std::string& name);
  static wire::ClientMessage hello(const std::string& name);

  /// Reads until the other end closes the connection. Returns false if it has not after 30 s.
  bool waitForHangup();
  /// True if the other end is known to have closed the connection. Discards unread bytes.
  bool isHungUp();
  /// Reads at most `most` bytes of those that have arrived. Returns the number of bytes read.
  std::size_t takeSome(std::size_t most);
  /// Returns the bytes that were read but not used yet.
  std::string& unread() { return m_unread; }
  /// Removes and returns the first frame of unread(); nullopt if it is incomplete.
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
