// Connections from many addresses that get no further than the door, in a thread of their own. Those that the
// server hangs up on come back at once.
#pragma once

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace naiad::test {

class SilentCrowd {
 public:
  /// What its connections say: nothing; the beginning of a ClientHello; a whole one, but no answer to what
  /// the server says then; the same, but all begin theirs before the first one finishes it; the whole
  /// handshake, but no hello of the protocol.
  enum class Kind { kSilent, kBegunHello, kWholeHello, kFinishedTogether, kNoHello };

  /// `each` connections from each of the addresses, which are in 127/8.
  SilentCrowd(std::uint16_t server, const std::vector<std::string>& addresses, int each, Kind kind);
  ~SilentCrowd();
  SilentCrowd(const SilentCrowd&) = delete;
  SilentCrowd& operator=(const SilentCrowd&) = delete;

  /// Connections that the server hung up on, so far.
  std::uint64_t hungUp() const { return m_hung_up; }
  /// With kFinishedTogether: all have begun their hellos, and finished them.
  bool haveFinished() const { return m_finished; }

 private:
  struct One;

  void finishHello(One& one);

  asio::io_context m_context;
  std::atomic<std::uint64_t> m_hung_up = 0;
  asio::steady_timer m_timer{m_context};
  std::atomic<bool> m_finished = false;
  std::string m_rest;  ///< of a hello that is not completed at once
  std::vector<std::shared_ptr<One>> m_all;
  std::thread m_thread;
};

}  // namespace naiad::test
