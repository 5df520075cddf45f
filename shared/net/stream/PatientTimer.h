// A time-out for an answer from elsewhere.
//
// A process that gets no processor for a while finds both when it goes on: the answer, which came in the
// meantime and is not read yet, and its time-out, which is over. So the time is waited for in parts, and a
// part that took longer than it should counts as what it should have taken (see also IdleTimer).
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
class PatientTimer {
 public:
  using Duration = asio::steady_timer::duration;

  /// Into so many parts a time is divided.
  static constexpr int kParts = 8;

  explicit PatientTimer(const asio::any_io_executor& executor) : m_timer(executor) {}
  explicit PatientTimer(asio::io_context& context) : m_timer(context) {}

  /// Call `over` after `time` in which this process ran. Takes the place of a time-out under way. `over` has
  /// to keep this timer alive; it is let go of when it was called, or soon after cancel().
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
