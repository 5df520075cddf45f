// A timeout for a peer's answer that excludes stalls of this process.
//
// After this process got no CPU time for a while, the answer may have arrived unread although the timeout has
// expired. So the timer divides the time into parts. A part that took too long counts only with its planned
// length (see also IdleTimer).
#pragma once

#include <asio/any_io_executor.hpp>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

namespace naiad {

/// Thread: the one that runs the executor.
class StallTolerantTimer {
 public:
  using Duration = asio::steady_timer::duration;

  /// Number of parts into which a timeout is divided.
  static constexpr int kParts = 8;

  explicit StallTolerantTimer(const asio::any_io_executor& executor) : m_timer(executor) {}
  explicit StallTolerantTimer(asio::io_context& context) : m_timer(context) {}

  /// Calls `over` after this process ran for `time`. Replaces a pending timeout. `over` must keep this timer
  /// alive; the function is destroyed after its call, or soon after cancel().
  void start(Duration time, std::function<void()> over) {
    wait(time / kParts, kParts, ++m_started, std::move(over));
  }
  void cancel() {
    ++m_started;
    m_timer.cancel();
  }

 private:
  void wait(Duration part, int parts, std::uint64_t started, std::function<void()> over) {
    m_timer.expires_after(part);
    m_timer.async_wait(
        [this, part, parts, started, over = std::move(over)](const std::error_code& error) mutable {
          if (error || started != m_started) return;
          if (parts == 1) return over();
          wait(part, parts - 1, started, std::move(over));
        });
  }

  asio::steady_timer m_timer;
  std::uint64_t m_started = 0;
};

}  // namespace naiad
