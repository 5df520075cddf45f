// Replaces dfserver behind a gateway: listens on a visitors' socket with TLS, and records the addresses and
// frames of its clients.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "GatewayRun.h"
#include "host/auth/ServerIdentity.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/ProxyListener.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad::test {

class FakeGame {
 public:
  /// Handles a frame on the game's thread. If it is empty, frames are sent back.
  using OnFrame = std::function<void(ReliableChannel& channel, const std::string& frame)>;

  /// Runs `job` on the game's thread and returns its result.
  template <class Job>
  auto onThread(Job job) {
    std::packaged_task<decltype(job())()> task(std::move(job));
    asio::post(m_context, [&] { task(); });
    return task.get_future().get();
  }

  /// Listens on `socket`. The key is in the folder `identity`; creates it if it is missing.
  FakeGame(const std::filesystem::path& identity, const std::filesystem::path& socket, OnFrame on_frame = {})
      : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
        m_on_frame(std::move(on_frame)) {
    if (!m_on_frame)
      m_on_frame = [](ReliableChannel& channel, const std::string& frame) { channel.send(frame); };
    ProxyListenerOptions listening;
    listening.path = socket;
    m_listener = std::make_unique<ProxyListener>(
        m_context, listening,
        [this](auto visitor, const auto& address) { meet(std::move(visitor), address); });
    m_thread = std::thread([this] { m_context.run(); });
  }
  ~FakeGame() {
    onThread([this] {
      m_listener.reset();
      m_channels.clear();
      m_timer.cancel();
    });
    m_work.reset();
    m_context.stop();
    m_thread.join();
  }
  FakeGame(const FakeGame&) = delete;
  FakeGame& operator=(const FakeGame&) = delete;

  ShortKey key() const { return ShortKey::of(m_identity.fingerprint()); }
  /// Returns the addresses of all clients so far, as "127.0.0.1:50312".
  std::vector<std::string> visitors() {
    const std::lock_guard lock(m_mutex);
    return m_visitors;
  }
  /// Returns all frames received from all clients.
  std::vector<std::string> frames() {
    const std::lock_guard lock(m_mutex);
    return m_frames;
  }
  std::size_t frameCount() {
    const std::lock_guard lock(m_mutex);
    return m_frames.size();
  }
  std::size_t connections() {
    return onThread([this] { return m_channels.size(); });
  }
  /// Returns how many handshakes have ended, successfully or not.
  std::size_t handshakes() {
    return onThread([this] { return m_handshakes; });
  }
  /// Drops the next `count` connections, like a crowded server.
  void hangUpOn(int count) {
    onThread([this, count] { return m_unwanted = count; });
  }
  /// Sends a frame to all clients.
  void broadcast(const std::string& frame) { broadcast(std::vector<std::string>{frame}); }
  /// Sends several frames at once to all clients.
  void broadcast(const std::vector<std::string>& frames) {
    onThread([&] {
      for (const auto& [id, channel] : m_channels) {
        for (const std::string& frame : frames) channel->send(frame);
      }
    });
  }
  /// Ends all streams, either in order or without notice, like a killed process.
  void endAll(bool in_order) {
    onThread([&] {
      for (const auto& [id, channel] : m_channels) {
        in_order ? channel->close() : static_cast<void>(::shutdown(m_sockets.at(id), SHUT_RDWR));
      }
    });
  }
  /// Calls `job` for each channel at this interval, on the game's thread.
  void every(std::chrono::milliseconds period, std::function<void(ReliableChannel&)> job) {
    onThread([&] {
      m_job = std::move(job);
      m_timer.expires_after(period);
      tick(period);
    });
  }

 private:
  void meet(asio::generic::stream_protocol::socket socket, const asio::ip::tcp::endpoint& address) {
    {
      const std::lock_guard lock(m_mutex);
      m_visitors.push_back(peerName(address));
    }
    if (m_unwanted > 0) {
      --m_unwanted;
      return;
    }
    auto handshake =
        std::make_shared<TlsHandshake>(std::make_unique<TlsStream>(std::move(socket), m_identity.tls()));
    handshake->run(std::chrono::seconds(30),
                   [this](TlsHandshake::End, std::unique_ptr<TlsStream> stream, const std::string&) {
                     ++m_handshakes;
                     if (stream) serve(std::move(stream));
                   });
  }
  void serve(std::unique_ptr<TlsStream> stream) {
    const int id = ++m_newest;
    m_sockets[id] = stream->socket().native_handle();
    TcpOptions options;
    options.receive_limit = kMaxClientFrame;
    auto& channel = m_channels[id] = makeTcpChannel(std::move(stream), options);
    ReliableChannel::Callbacks callbacks;
    callbacks.on_frame = [this, id](std::string_view frame) {
      {
        const std::lock_guard lock(m_mutex);
        m_frames.emplace_back(frame);
      }
      m_on_frame(*m_channels.at(id), std::string(frame));
    };
    callbacks.on_closed = [this, id](CloseReason) {
      m_channels.erase(id);
      m_sockets.erase(id);
    };
    channel->start(std::move(callbacks));
  }
  void tick(std::chrono::milliseconds period) {
    m_timer.async_wait([this, period](const std::error_code& error) {
      if (error) return;
      for (const auto& [id, channel] : m_channels) m_job(*channel);
      m_timer.expires_at(m_timer.expiry() + period);
      tick(period);
    });
  }

  ServerIdentity m_identity;
  OnFrame m_on_frame;
  asio::io_context m_context;
  asio::executor_work_guard<asio::io_context::executor_type> m_work{m_context.get_executor()};
  asio::steady_timer m_timer{m_context};
  std::function<void(ReliableChannel&)> m_job;
  std::mutex m_mutex;
  std::vector<std::string> m_visitors;
  std::vector<std::string> m_frames;
  std::map<int, std::unique_ptr<ReliableChannel>> m_channels;
  std::map<int, int> m_sockets;
  int m_newest = 0;
  std::size_t m_handshakes = 0;
  int m_unwanted = 0;
  std::unique_ptr<ProxyListener> m_listener;
  std::thread m_thread;
};

/// A game and a gateway to it.
class GatewayFixture : public testing::Test {
 protected:
  /// Starts a game, which echoes frames unless `on_frame` is given, and a gateway to it.
  void start(FakeGame::OnFrame on_frame = {}, const std::function<void(GatewaySettings&)>& change = {}) {
    game = std::make_unique<FakeGame>(home.path("identity"), home.path("visitors"), std::move(on_frame));
    GatewaySettings settings = home.settings(game->key());
    if (change) change(settings);
    gateway = std::make_unique<GatewayRun>(settings);
  }

  GatewayHome home;
  std::unique_ptr<FakeGame> game;
  std::unique_ptr<GatewayRun> gateway;
};

}  // namespace naiad::test
