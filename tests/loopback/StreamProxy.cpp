#include "StreamProxy.h"

#include <array>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>

namespace naiad::test {

using asio::ip::tcp;

/// A client's socket and the proxy's socket to the server.
struct StreamProxy::Line {
  explicit Line(asio::io_context& context)
      : ends{tcp::socket(context), tcp::socket(context)},
        timers{asio::steady_timer(context), asio::steady_timer(context)} {}
  void close() {
    closed = true;
    for (tcp::socket& end : ends) {
      asio::error_code ignored;
      end.close(ignored);
    }
  }
  std::array<tcp::socket, 2> ends;
  std::array<asio::steady_timer, 2> timers;
  std::array<std::array<char, 16384>, 2> buffers{};
  bool stalled = false;
  bool closed = false;  ///< true after close(); the proxy may already be destroyed then
};

StreamProxy::StreamProxy(asio::io_context& context, std::uint16_t server_port)
    : m_context(context),
      m_acceptor(context, {asio::ip::address_v4::loopback(), 0}),
      m_server_port(server_port) {
  accept();
}

StreamProxy::~StreamProxy() {
  cut();
}

void StreamProxy::accept() {
  auto line = std::make_shared<Line>(m_context);
  m_acceptor.async_accept(line->ends[0], [this, line](const asio::error_code& error) {
    if (error) return;
    asio::error_code refused;
    line->ends[1].open(tcp::v4(), refused);
    line->ends[1].bind({m_own_address, 0}, refused);
    if (m_open) line->ends[1].connect({asio::ip::address_v4::loopback(), m_server_port}, refused);
    if (m_open && !refused) {
      for (tcp::socket& end : line->ends) end.set_option(tcp::no_delay(true), refused);
      m_lines.push_back(line);
      ++m_count;
      pump(line, 0);
      pump(line, 1);
    }
    accept();
  });
}

void StreamProxy::pump(const std::shared_ptr<Line>& line, std::size_t from) {
  line->ends[from].async_read_some(asio::buffer(line->buffers[from]),
                                   [this, line, from](const asio::error_code& error, std::size_t size) {
                                     if (line->stalled || line->closed) return;
                                     if (error) return line->close();
                                     if (m_delay.count() == 0) return passOn(line, from, size);
                                     line->timers[from].expires_after(m_delay);
                                     line->timers[from].async_wait([this, line, from, size](auto stopped) {
                                       if (!stopped && !line->closed) passOn(line, from, size);
                                     });
                                   });
}

void StreamProxy::passOn(const std::shared_ptr<Line>& line, std::size_t from, std::size_t size) {
  asio::async_write(line->ends[1 - from], asio::buffer(line->buffers[from], size),
                    [this, line, from](const asio::error_code& failed, std::size_t) {
                      if (line->closed) return;
                      failed ? line->close() : pump(line, from);
                    });
}

void StreamProxy::cut() {
  for (const auto& line : m_lines) line->close();
  m_lines.clear();
}

void StreamProxy::stall() {
  for (const auto& line : m_lines) line->stalled = true;
}

void StreamProxy::stallOldest() {
  m_lines.front()->stalled = true;
}

}  // namespace naiad::test
