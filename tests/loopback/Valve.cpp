#include "Valve.h"

#include <asio/steady_timer.hpp>
#include <utility>

namespace naiad::test {

namespace {

class ValveSocket : public DatagramSocket {
 public:
  ValveSocket(asio::io_context& context, std::shared_ptr<Valve> valve)
      : m_context(context), m_valve(std::move(valve)), m_socket(context, UdpOptions{}) {
    m_valve->p_socket = &m_socket;
  }

  void start(OnPacket on_packet) override {
    m_on_packet = std::move(on_packet);
    m_socket.start([this](const Path& path, std::string_view packet) {
      if (!m_valve->down) return;
      later([this, path, bytes = std::string(packet)] { m_on_packet(path, bytes); });
    });
  }
  void send(const Path& path, std::string_view packet) override {
    m_valve->seen.emplace_back(packet);
    if (!m_valve->up) return;
    Path real = path;
    if (m_valve->server_port != 0) real.remote.port = m_valve->server_port;
    later([this, real, bytes = std::string(packet)] {
      m_socket.send(real, bytes);
      m_socket.flush();
    });
  }
  void flush() override { m_socket.flush(); }
  void reopen() override { m_socket.reopen(); }
  Endpoint localEndpoint() const override { return m_socket.localEndpoint(); }

 private:
  void later(std::function<void()> action) {
    if (m_valve->delay.count() == 0) return action();
    auto timer = std::make_shared<asio::steady_timer>(m_context, m_valve->delay);
    timer->async_wait([timer, action = std::move(action), alive = std::weak_ptr(m_alive)](auto) {
      if (!alive.expired()) action();
    });
  }

  asio::io_context& m_context;
  std::shared_ptr<Valve> m_valve;
  OnPacket m_on_packet;
  std::shared_ptr<bool> m_alive = std::make_shared<bool>();
  UdpSocket m_socket;
};

}  // namespace

std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> through(asio::io_context& context,
                                                                               std::shared_ptr<Valve> valve) {
  return [&context, valve = std::move(valve)](const Endpoint&) {
    return std::make_unique<ValveSocket>(context, valve);
  };
}

}  // namespace naiad::test
