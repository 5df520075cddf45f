// A thread that watches the tick thread, which notices nothing while a game does not return from a handler.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "host/process/StopSignals.h"
#include "host/world/TickStallMeter.h"
#include "shared/program/JobThread.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// A log for threads that must not wait, such as the one that ends a server whose game may hold its lock.
/// Passes lines on, in order, on a thread of its own, which is started in advance.
class AsyncLog {
 public:
  explicit AsyncLog(LogLine log) : m_log(std::move(log)) {
    m_thread.enqueue([] {});
  }

  /// Adds a line, without waiting for the log. Any thread.
  void operator()(const std::string& line) {
    m_thread.enqueue([this, line] { m_log(line); });
  }
  /// Waits until all lines are passed on, at most `most`. Any thread.
  void waitUntilLogged(std::chrono::milliseconds most);

 private:
  LogLine m_log;
  JobThread m_thread;  ///< last, because it uses the log; its end waits for all lines
};

/// Decides, by the duration of the tick, whether the game hangs and whether the server must end without it.
/// Single-threaded. Time is passed in.
class HangDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time in one tick after which the game counts as hanging.
  static constexpr std::chrono::seconds kHangTime{1};
  /// After a request to end, the server exits without its game if a tick takes kTickBeforeEnd and the first
  /// signal came at least kSignalBeforeEnd ago.
  static constexpr std::chrono::seconds kTickBeforeEnd{3};
  static constexpr std::chrono::seconds kSignalBeforeEnd{1};

  enum class Step {
    kNothing,
    kReport,    ///< report that the game hangs: once for each tick
    kExitHung,  ///< end without the game: an end was requested, and the tick does not finish
    kExitNow,   ///< end without the game: an end was requested twice
  };

  /// Returns what to do. `tick` and `since`: number and start of the running tick, if any. `stops`: number of
  /// signals so far that ask for the end.
  Step check(std::optional<std::uint64_t> tick, Time since, int stops, Time now) {
    if (stops > 0 && !m_asked_at) m_asked_at = now;
    if (stops > 1) return Step::kExitNow;
    if (!tick) return Step::kNothing;
    if (m_asked_at && now - since >= kTickBeforeEnd && now - *m_asked_at >= kSignalBeforeEnd)
      return Step::kExitHung;
    if (now - since < kHangTime || m_reported == tick) return Step::kNothing;
    m_reported = tick;
    return Step::kReport;
  }

 private:
  std::optional<Time> m_asked_at;
  std::optional<std::uint64_t> m_reported;
};

/// The reason why a server ends without waiting for its game.
struct ForcedExit {
  bool hung = false;       ///< true: the tick took kHangTime or longer; false: only a second signal
  std::uint64_t tick = 0;  ///< the running tick; 0: none
  int signal = 0;          ///< the last signal that asked for the end
};

class Watchdog {
 public:
  /// Watches `signals` and the ticks that are reported to it, until it is destroyed. `frame`: length of a
  /// tick. `end` ends the process; it is called on the watching thread, and does not return. `log` is called
  /// there, too, and must not wait for anything the game may hold (AsyncLog).
  Watchdog(const StopSignals& signals, std::chrono::nanoseconds frame, LogLine log,
           std::function<void(const ForcedExit&)> end);
  ~Watchdog();

  /// Call beginTick() and endTick() on the thread that ticks.
  void beginTick(std::uint64_t number);
  void endTick() { m_since.store(0, std::memory_order_release); }

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  const StopSignals& m_signals;
  const std::chrono::nanoseconds m_frame;
  SlowTickDetector m_slow_tick;
  LogLine m_log;
  std::function<void(const ForcedExit&)> m_end;
  std::atomic<std::uint64_t> m_tick = 0;
  std::atomic<Clock::rep> m_since = 0;  ///< when the running tick began; 0: none is running
  std::mutex m_mutex;
  std::condition_variable m_changed;
  bool m_stopping = false;
  std::thread m_thread;
};

}  // namespace naiad
