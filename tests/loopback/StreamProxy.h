// A proxy between clients and a server's stream that can break, stall or delay connections.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace naiad::test {

/// Runs in `context`, which must outlive the proxy.
class StreamProxy {
 public:
  StreamProxy(asio::io_context& context, std::uint16_t server_port);
  ~StreamProxy();

  /// Returns the port to which clients connect.
  std::uint16_t port() const { return m_acceptor.local_endpoint().port(); }
  /// Closes both ends of all present connections.
  void cut();
  /// Stops passing on bytes of the present connections. Neither end gets an error.
  void stall();
  /// Like stall(), but only for the oldest connection.
  void stallOldest();
  /// If `open` is false, later connections are closed at once.
  void setOpen(bool open) { m_open = open; }
  /// Sets the delay of bytes in each direction.
  void setDelay(std::chrono::milliseconds delay) { m_delay = delay; }
  /// Sets the address in 127/8 from which later connections reach the server.
  void setOwnAddress(const std::string& address) { m_own_address = asio::ip::make_address(address); }
  /// Sets the server of later connections.
  void setServer(std::uint16_t port) { m_server_port = port; }
  /// Returns how many connections have reached the server so far.
  int count() const { return m_count; }

 private:
  struct Line;
  void accept();
  void pump(const std::shared_ptr<Line>& line, std::size_t from);
  void passOn(const std::shared_ptr<Line>& line, std::size_t from, std::size_t size);

  asio::io_context& m_context;
  asio::ip::tcp::acceptor m_acceptor;
  std::uint16_t m_server_port;
  asio::ip::address m_own_address = asio::ip::address_v4::loopback();
  std::vector<std::shared_ptr<Line>> m_lines;
  std::chrono::milliseconds m_delay{0};
  bool m_open = true;
  int m_count = 0;
};

}  // namespace naiad::test
