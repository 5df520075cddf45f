// Connections from many addresses that never join, in a thread of their own. They reconnect after the server
// has disconnected them.
#pragma once

#include <asio/io_context.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace naiad::test {

class SilentCrowd {
 public:
  /// What a connection sends. kSilent: nothing. kBegunHello: half a ClientHello. kWholeHello: a ClientHello,
  /// but no answer to the server's reply. kNoHello: the TLS handshake, but no hello of the protocol.
  enum class Kind { kSilent, kBegunHello, kWholeHello, kNoHello };

  /// Makes `each` connections from each of the addresses, which must be in 127/8.
  SilentCrowd(std::uint16_t server, const std::vector<std::string>& addresses, int each, Kind kind);
  ~SilentCrowd();
  SilentCrowd(const SilentCrowd&) = delete;
  SilentCrowd& operator=(const SilentCrowd&) = delete;

  /// Returns how many connections the server has closed so far.
  std::uint64_t hungUp() const { return m_hung_up; }

 private:
  struct One;

  asio::io_context m_context;
  std::atomic<std::uint64_t> m_hung_up = 0;
  std::vector<std::shared_ptr<One>> m_all;
  std::thread m_thread;
};

}  // namespace naiad::test
