// A connection that sends whatever bytes a test wants to an HTTP server that closes after each answer.
// Blocking, with deadlines; plain TCP on loopback.
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

  /// Errors (the other end hung up) are ignored.
  void send(std::string_view bytes) {
    asio::error_code ignored;
    asio::write(m_socket, asio::buffer(bytes.data(), bytes.size()), ignored);
  }
  /// All that comes until the other end hangs up; what came by then after 60 s.
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
  /// The other end has ended the connection, as readAll() found.
  bool isHungUp() const { return m_hung_up; }
  /// Read the answer.
  Reply reply() {
    const std::string all = readAll();
    const std::size_t end = all.find("\r\n\r\n");
    if (!all.starts_with("HTTP/1.1 ") || end == std::string::npos) return {};
    return {std::atoi(all.c_str() + 9), all.substr(0, end + 2), all.substr(end + 4)};
  }

  /// One request, as a scraper sends it.
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

/// The value of a sample on a page of metrics, by its name and labels as they stand there; -1: there is none.
inline double metricOf(const std::string& page, const std::string& sample) {
  const std::string line = "\n" + sample + " ";
  const std::size_t at = page.find(line);
  return at == std::string::npos ? -1 : std::strtod(page.c_str() + at + line.size(), nullptr);
}

}  // namespace naiad::test
