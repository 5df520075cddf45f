// A server that no game stands behind: it welcomes a client and sends it a pile of objects.
#pragma once

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "shared/net/base/Channel.h"
#include "shared/net/stream/TcpListener.h"

namespace bench::attack {

class PileServer {
 public:
  static constexpr std::uint32_t kObjects = 48'000;

  /// With a key of its own in `folder`; runs in a thread of its own.
  explicit PileServer(const std::string& folder);
  ~PileServer();
  PileServer(const PileServer&) = delete;
  PileServer& operator=(const PileServer&) = delete;

  std::uint16_t port() const { return m_listener->port(); }
  const std::string& fingerprint() const { return m_fingerprint; }
  /// Objects sent to the present client.
  std::uint32_t sent() const { return m_sent; }

 private:
  void receive(std::string_view frame);
  void welcome();
  void tick();
  void sendSnapshot();

  asio::io_context m_context{1};
  asio::steady_timer m_timer{m_context};
  std::string m_fingerprint;
  std::unique_ptr<naiad::TcpListener> m_listener;
  std::unique_ptr<naiad::ReliableChannel> m_channel;
  std::atomic<std::uint32_t> m_sent{0};
  std::uint32_t m_number = 0;
  std::uint32_t m_tick = 0;
  std::thread m_thread;
};

}  // namespace bench::attack
