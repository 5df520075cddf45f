// Replaces dfserver behind a gateway: listens on a visitors' socket with TLS, and records the addresses and
// frames of its clients.
#pragma once

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

#include "host/auth/ServerIdentity.h"
#include "shared/net/base/Channel.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/ProxyListener.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad::test {

class FakeGame {
 public:
  /// Handles a frame on the game's thread. If it is empty, frames are sent back.
  using OnFrame = std::function<void(ReliableChannel& channel, const std::string& frame)>;

  /// Listens on `socket`. The key is in the folder `identity`; creates it if it is missing.
  FakeGame(const std::filesystem::path& identity, const std::filesystem::path& socket, OnFrame on_frame = {});
  ~FakeGame();
  FakeGame(const FakeGame&) = delete;
  FakeGame& operator=(const FakeGame&) = delete;

  /// Runs `job` on the game's thread and returns its result.
  template <class Job>
  auto onThread(Job job) {
    std::packaged_task<decltype(job())()> task(std::move(job));
    asio::post(m_context, [&] { task(); });
    return task.get_future().get();
  }

  ShortKey key() const { return ShortKey::of(m_identity.fingerprint()); }
  /// Returns the addresses of all clients so far, as "127.0.0.1:50312".
  std::vector<std::string> visitors();
  /// Returns all frames received from all clients.
  std::vector<std::string> frames();
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
  void broadcast(const std::vector<std::string>& frames);
  /// Ends all streams, either in order or without notice, like a killed process.
  void endAll(bool in_order);
  /// Calls `job` for each channel at this interval, on the game's thread.
  void every(std::chrono::milliseconds period, std::function<void(ReliableChannel&)> job);

 private:
  void meet(asio::generic::stream_protocol::socket socket, const asio::ip::tcp::endpoint& address);
  void serve(std::unique_ptr<TlsStream> stream);
  void tick(std::chrono::milliseconds period);

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

}  // namespace naiad::test
