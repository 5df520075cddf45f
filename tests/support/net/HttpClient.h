// A blocking HTTP client that can send arbitrary bytes, for servers on loopback that close after each answer.
// Plain TCP, with timeouts.
#pragma once

#include <poll.h>

#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/address_v4.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace naiad::test {

class HttpClient {
 public:
  struct Reply {
    int status = 0;  ///< 0: the connection ended without an answer
    std::string head;
    std::string body;
  };

  explicit HttpClient(std::uint16_t port) {
    asio::error_code ignored;
    m_socket.connect({asio::ip::address_v4::loopback(), port}, ignored);
  }

  /// Ignores errors, for example when the other end has closed the connection.
  void send(std::string_view bytes) {
    asio::error_code ignored;
    asio::write(m_socket, asio::buffer(bytes.data(), bytes.size()), ignored);
  }
  /// Reads until the other end closes the connection or sends nothing for 60 s. Returns what was read.
  std::string readAll() {
    std::string all;
    std::array<char, 4096> piece;
    asio::error_code error;
    for (pollfd ready{m_socket.native_handle(), POLLIN, 0}; !error && poll(&ready, 1, 60'000) > 0;) {
      const std::size_t size = m_socket.read_some(asio::buffer(piece), error);
      all.append(piece.data(), size);
    }
    m_hung_up = error.value() != 0;
    return all;
  }
  /// True if the last readAll() found that the other end closed the connection.
  bool isHungUp() const { return m_hung_up; }
  /// Reads and parses the answer.
  Reply reply() {
    const std::string all = readAll();
    const std::size_t end = all.find("\r\n\r\n");
    if (!all.starts_with("HTTP/1.1 ") || end == std::string::npos) return {};
    return {std::atoi(all.c_str() + 9), all.substr(0, end + 2), all.substr(end + 4)};
  }

  /// Sends one GET request like a metrics scraper does, and returns the answer.
  static Reply get(std::uint16_t port, const std::string& path) {
    HttpClient client(port);
    client.send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n");
    return client.reply();
  }

 private:
  asio::io_context m_context;
  asio::ip::tcp::socket m_socket{m_context};
  bool m_hung_up = false;
};

/// Returns the value of a sample, given by name and labels, on a metrics page; -1 if it is missing.
inline double metricOf(const std::string& page, const std::string& sample) {
  const std::string line = "\n" + sample + " ";
  const std::size_t at = page.find(line);
  return at == std::string::npos ? -1 : std::strtod(page.c_str() + at + line.size(), nullptr);
}

}  // namespace naiad::test
