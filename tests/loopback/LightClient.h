// A client that sends hello and then only listens, so a thousand of them fit into a test. Each can have its
// own address.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad::test {

class LightClient {
 public:
  enum class State { kIdle, kJoining, kWelcome, kRefused, kHungUp };

  /// `address` is the client's own address, in 127/8. Runs in `context`, which must outlive this client.
  LightClient(asio::io_context& context, std::uint16_t server, const std::string& address);
  ~LightClient();
  LightClient(const LightClient&) = delete;
  LightClient& operator=(const LightClient&) = delete;

  /// Connects with TLS and sends hello, with the token of the last welcome if there was one.
  void join();
  /// Calls join() after a pause.
  void joinAfter(std::chrono::milliseconds pause);
  /// Joins and, like Connection, retries until it is accepted: after 0.25 s, 0.5 s and so on up to 2 s.
  void joinUntilWelcome();
  /// Closes the connection without a goodbye.
  void drop();

  State state() const { return m_state; }
  const wire::Welcome& welcome() const { return m_welcome; }
  /// Sets a function that is called when a join succeeds or fails.
  void onJudged(std::function<void(LightClient&)> callback) { m_on_judged = std::move(callback); }

 private:
  void onFrame(std::string_view frame);
  void end(State state);

  asio::io_context& m_context;
  asio::ip::tcp::endpoint m_server;
  asio::ip::tcp::endpoint m_own;
  asio::steady_timer m_timer;
  std::shared_ptr<asio::ip::tcp::socket> m_socket;  ///< set while the client connects
  std::shared_ptr<TlsHandshake> m_handshake;
  std::unique_ptr<ReliableChannel> m_channel;
  State m_state = State::kIdle;
  wire::Welcome m_welcome;
  std::function<void(LightClient&)> m_on_judged;
  bool m_insists = false;
  std::chrono::milliseconds m_backoff{250};
};

}  // namespace naiad::test
