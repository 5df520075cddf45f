// A server with its own key that sends nothing and records every byte that clients send after the handshake.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "host/auth/ServerIdentity.h"

namespace naiad::test {

/// Serves one connection after another in its own thread.
class RecordingServer {
 public:
  /// Loads the key from that folder, or creates it there.
  explicit RecordingServer(const std::filesystem::path& identity);
  ~RecordingServer();
  RecordingServer(const RecordingServer&) = delete;
  RecordingServer& operator=(const RecordingServer&) = delete;

  std::uint16_t port() const { return m_port; }
  const Fingerprint& fingerprint() const { return m_identity.fingerprint(); }
  /// True if clients have closed this many connections after a complete handshake, and all their bytes have
  /// been read. Also true once any byte has been recorded.
  bool isDecided(int connections) const { return m_finished >= connections || !heard().empty(); }
  /// Returns the content of the TLS records of all connections.
  std::string heard() const;

 private:
  void run();
  void serve(int socket);
  bool await(int socket, bool out) const;

  ServerIdentity m_identity;
  asio::io_context m_context;
  asio::ip::tcp::acceptor m_acceptor;
  std::uint16_t m_port;
  std::atomic<int> m_finished = 0;
  std::atomic<bool> m_stopping = false;
  mutable std::mutex m_mutex;
  std::string m_heard;
  std::thread m_thread;
};

}  // namespace naiad::test
