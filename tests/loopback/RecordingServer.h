// A server with a key of its own that says nothing and keeps every byte that clients say to it after the
// handshake.
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

/// Serves one connection after the other, on a thread of its own.
class RecordingServer {
 public:
  /// The key is in that directory, or made there.
  explicit RecordingServer(const std::filesystem::path& identity);
  ~RecordingServer();
  RecordingServer(const RecordingServer&) = delete;
  RecordingServer& operator=(const RecordingServer&) = delete;

  std::uint16_t port() const { return m_port; }
  const Fingerprint& fingerprint() const { return m_identity.fingerprint(); }
  /// So many connections with a complete handshake are over, since the client has closed them, and all that
  /// it sent has been read; or it has said something.
  bool isDecided(int connections) const { return m_finished >= connections || !heard().empty(); }
  /// What was in the TLS records of all connections.
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
