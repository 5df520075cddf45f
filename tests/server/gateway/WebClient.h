// A browser's connection that can send any bytes: HTTP, WebSocket frames, or neither. Uses plain TCP. Its
// functions block, with timeouts.
#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <cerrno>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/loopback/RawClient.h"

namespace naiad::test {

inline std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

inline unsigned byteOf(const std::string& text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

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
  int closeCode() const {
    return payload.size() < 2 ? 1005 : static_cast<int>(byteOf(payload, 0) << 8 | byteOf(payload, 1));
  }
};

class WebClient {
 public:
  /// Connects from a loopback address (any in 127.0.0.0/8). `receive_buffer`: size of the kernel's receive
  /// buffer in bytes; 0: default.
  explicit WebClient(std::uint16_t port, const std::string& from = "127.0.0.1", int receive_buffer = 0)
      : m_host("127.0.0.1:" + std::to_string(port)) {
    m_socket.open(asio::ip::tcp::v4());
    if (receive_buffer > 0) m_socket.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
    m_socket.bind({asio::ip::make_address(from), 0});
    m_socket.connect({asio::ip::address_v4::loopback(), port});
    m_socket.non_blocking(true);
  }

  /// Sends bytes. Ignores errors, such as a connection closed by the other end.
  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto sent = ::send(m_socket.native_handle(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
      } else if ((errno != EAGAIN && errno != EWOULDBLOCK) || !await(POLLOUT)) {
        return;
      }
    }
  }
  /// Sends "GET PATH" with the right Host for the port and these additional header lines.
  void get(const std::string& path, const std::string& lines = "", const std::string& method = "GET") {
    send(method + " " + path + " HTTP/1.1\r\nHost: " + m_host + "\r\n" + lines + "\r\n");
  }
  /// Returns the next reply; nullopt if the connection ended, or after 30 s. `has_body`: false for HEAD.
  std::optional<HttpReply> reply(bool has_body = true) {
    std::size_t end = 0;
    while ((end = m_unread.find("\r\n\r\n")) == std::string::npos) {
      if (!readMore()) return std::nullopt;
    }
    HttpReply reply;
    const std::string head = m_unread.substr(0, end + 2);
    m_unread.erase(0, end + 4);
    if (!head.starts_with("HTTP/1.1 ")) return std::nullopt;
    reply.status = std::stoi(head.substr(9, 3));
    for (std::size_t at = head.find("\r\n") + 2; at < head.size();) {
      const std::size_t colon = head.find(": ", at);
      const std::size_t line_end = head.find("\r\n", at);
      reply.headers[lowered(head.substr(at, colon - at))] = head.substr(colon + 2, line_end - colon - 2);
      at = line_end + 2;
    }
    const auto length = reply.headers.find("content-length");
    if (!has_body || length == reply.headers.end()) return reply;
    const std::size_t size = std::stoul(length->second);
    while (m_unread.size() < size) {
      if (!readMore()) return std::nullopt;
    }
    reply.body = m_unread.substr(0, size);
    m_unread.erase(0, size);
    return reply;
  }
  std::optional<HttpReply> ask(const std::string& path, const std::string& lines = "") {
    get(path, lines);
    return reply();
  }

  /// Sends a WebSocket request. `changes` replaces headers of the same name; "Name:" removes one.
  void requestPlay(const std::string& changes = "") {
    std::string request = "GET /play HTTP/1.1\r\n" + changes;
    const std::string other = lowered("\r\n" + changes);
    const std::array<std::pair<const char*, std::string>, 7> lines{{
        {"Host", m_host},
        {"Connection", "Upgrade"},
        {"Upgrade", "websocket"},
        {"Origin", "http://" + m_host},
        {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="},
        {"Sec-WebSocket-Version", "13"},
        {"Sec-WebSocket-Protocol", "naiad.1"},
    }};
    for (const auto& [name, value] : lines) {
      if (other.find(lowered("\r\n" + std::string(name) + ":")) == std::string::npos)
        request += std::string(name) + ": " + value + "\r\n";
    }
    send(request + "\r\n");
  }
  /// Opens a WebSocket as the page does. Returns false if the server refuses it.
  bool play() {
    requestPlay();
    const auto answer = reply(false);
    return answer && answer->status == 101;
  }
  static std::string frameBytes(int opcode, std::string_view payload, bool is_last = true,
                                bool is_masked = true) {
    std::string frame(1, static_cast<char>((is_last ? 0x80 : 0) | opcode));
    const int mask = is_masked ? 0x80 : 0;
    if (payload.size() < 126) {
      frame.push_back(static_cast<char>(mask | static_cast<int>(payload.size())));
    } else if (payload.size() < 65'536) {
      frame.push_back(static_cast<char>(mask | 126));
      for (const int shift : {8, 0}) frame.push_back(static_cast<char>(payload.size() >> shift & 0xff));
    } else {
      frame.push_back(static_cast<char>(mask | 127));
      for (int shift = 56; shift >= 0; shift -= 8)
        frame.push_back(static_cast<char>(payload.size() >> shift & 0xff));
    }
    if (is_masked) frame += kMask;
    for (std::size_t i = 0; i < payload.size(); ++i)
      frame.push_back(static_cast<char>(is_masked ? payload[i] ^ kMask[i % 4] : payload[i]));
    return frame;
  }
  /// Sends one frame, masked as browsers do.
  void sendFrame(int opcode, std::string_view payload, bool is_last = true, bool is_masked = true) {
    send(frameBytes(opcode, payload, is_last, is_masked));
  }
  void sendMessage(const wire::ClientMessage& message) { sendFrame(2, message.SerializeAsString()); }
  /// Returns the next frame; nullopt if the connection ended, or after 30 s.
  std::optional<WebFrame> frame() {
    for (;;) {
      if (auto whole = takeFrame()) return whole;
      if (!readMore()) return std::nullopt;
    }
  }
  /// Returns the next binary message; answers pings before it. Returns nullopt if the WebSocket was closed.
  std::optional<wire::ServerMessage> message() {
    while (const auto next = frame()) {
      if (next->opcode == 9) sendFrame(10, next->payload);
      if (next->opcode == 8) return std::nullopt;
      wire::ServerMessage message;
      if (next->opcode == 2 && message.ParseFromString(next->payload)) return message;
    }
    return std::nullopt;
  }
  /// Reads until the WebSocket is closed. Returns the close code, 0 without close frame, -1 after 30 s.
  int waitForClose() {
    while (const auto next = frame()) {
      if (next->opcode != 8) continue;
      sendFrame(8, next->payload);
      return next->closeCode();
    }
    return m_timed_out ? -1 : 0;
  }
  /// Sends a hello and waits for the welcome.
  bool join(const std::string& name) {
    if (!play()) return false;
    sendMessage(RawClient::hello(name));
    const auto answer = message();
    return answer && answer->has_welcome();
  }

  /// Reads until the other end closes the connection. Returns false if it has not after 30 s.
  bool waitForHangup() {
    while (readMore()) m_unread.clear();
    return !m_timed_out;
  }
  /// True if the other end is known to have closed the connection. Discards unread bytes.
  bool isHungUp() {
    char bytes[4096];
    for (;;) {
      const auto got = ::recv(m_socket.native_handle(), bytes, sizeof bytes, 0);
      if (got == 0) return true;
      if (got < 0) return errno != EAGAIN && errno != EWOULDBLOCK;
    }
  }
  /// Reads at most `most` bytes of those that have arrived. Returns the number of bytes read.
  std::size_t takeSome(std::size_t most) {
    std::vector<char> bytes(most);
    const auto got = ::recv(m_socket.native_handle(), bytes.data(), bytes.size(), 0);
    if (got <= 0) return 0;
    m_unread.append(bytes.data(), static_cast<std::size_t>(got));
    return static_cast<std::size_t>(got);
  }
  /// Removes and returns the first of the frames that were read; nullopt if it is incomplete.
  std::optional<WebFrame> takeFrame() {
    if (m_unread.size() < 2) return std::nullopt;
    std::size_t size = byteOf(m_unread, 1);
    std::size_t head = 2;
    if (size == 126) {
      if (m_unread.size() < 4) return std::nullopt;
      size = byteOf(m_unread, 2) << 8 | byteOf(m_unread, 3);
      head = 4;
    }
    if (m_unread.size() < head + size) return std::nullopt;
    WebFrame frame{static_cast<int>(byteOf(m_unread, 0) & 15), m_unread.substr(head, size)};
    m_unread.erase(0, head + size);
    return frame;
  }

 private:
  static constexpr int kPatienceMillis = 30'000;
  static constexpr std::string_view kMask{"\x12\x34\x56\x78", 4};

  bool readMore() {
    while (takeSome(16'384) == 0) {
      char byte = 0;
      const auto seen = ::recv(m_socket.native_handle(), &byte, 1, MSG_PEEK);
      if (seen > 0) continue;
      if (seen == 0 || (errno != EAGAIN && errno != EWOULDBLOCK) || !await(POLLIN)) return false;
    }
    return true;
  }
  bool await(short events) {
    pollfd watched{m_socket.native_handle(), events, 0};
    m_timed_out = poll(&watched, 1, kPatienceMillis) <= 0;
    return !m_timed_out;
  }

  asio::io_context m_context;
  asio::ip::tcp::socket m_socket{m_context};
  std::string m_host;
  std::string m_unread;
  bool m_timed_out = false;
};

}  // namespace naiad::test
