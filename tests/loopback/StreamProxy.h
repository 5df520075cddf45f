// Stands between clients and a server's stream, and can take the line away.
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

/// Runs in `context`, which must outlive it.
class StreamProxy {
 public:
  StreamProxy(asio::io_context& context, std::uint16_t server_port);
  ~StreamProxy();

  /// Clients connect here.
  std::uint16_t port() const { return m_acceptor.local_endpoint().port(); }
  /// Both ends of all present connections lose them.
  void cut();
  /// Nothing goes through the present connections any more, and neither end gets an error.
  void stall();
  /// The same for the one that was made first.
  void stallOldest();
  /// Closed: later connections are closed at once.
  void setOpen(bool open) { m_open = open; }
  /// Bytes are delayed by this, in each direction.
  void setDelay(std::chrono::milliseconds delay) { m_delay = delay; }
  /// Later connections come to the server from this address in 127/8.
  void setOwnAddress(const std::string& address) { m_own_address = asio::ip::make_address(address); }
  /// Later connections lead to another server.
  void setServer(std::uint16_t port) { m_server_port = port; }
  /// Connections so far that went through.
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
