// Measures how long a world itself has delayed a tick, to tell whether its game hangs.
//
// On a loaded machine a process may have to wait for a processor, and in a debugger it does nothing. Neither
// is the game's fault, so only computing, and waiting for something that the game asked for, counts in full.
// A process stopped by a signal gets more, but limited time, because it may have sent the signal itself.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The state of a process, as the kernel reports it.
struct ProcessRunState {
  enum Doing {
    kRuns,      ///< it computes, waits for a processor, or waits for a disk
    kWaits,     ///< it waits for something that it asked for: a time, a lock, bytes
    kStopped,   ///< stopped by a signal
    kDebugged,  ///< stopped by a debugger; a sandboxed world cannot debug itself
  } doing = kRuns;
  std::chrono::nanoseconds cpu{0};  ///< processor time of all its threads since its start
};

/// Returns the state of a process; nullopt if it does not exist, or the kernel does not say.
std::optional<ProcessRunState> readProcessRunState(pid_t process);

/// Adds up the time that a tick has taken. Reads no clock: callers pass the time.
class TickStallMeter {
 public:
  using Nanos = std::chrono::nanoseconds;

  /// A tick's time counts in full, and the process's state is not read, until the tick has taken this long.
  static constexpr Nanos kUninspectedTime = std::chrono::milliseconds(50);
  /// The time in which a process is stopped by a signal, or waits for a processor or a disk, is divided by
  /// this. If it did not count at all, such a process would never count as hung.
  static constexpr int kStarvedPart = 10;

  /// Begins another tick.
  void restart() { *this = TickStallMeter(); }
  /// Adds the time `passed` since the last call. `look` returns the state of the process; it is called only
  /// if the tick has taken longer than kUninspectedTime.
  template <class Look>
  void add(Nanos passed, Look look) {
    m_passed += passed;
    if (m_passed <= kUninspectedTime) {
      m_counted += passed;
      m_own += passed;
    } else {
      count(passed, look());
    }
  }
  /// Returns the part of the tick's time that counts.
  Nanos counted() const { return m_counted; }
  /// Returns the part of counted() that no load, signal or debugger can have caused, apart from the first
  /// kUninspectedTime: computing, and waiting for something.
  Nanos own() const { return m_own; }
  /// Returns how long the process has been stopped without a break, by a signal or a debugger.
  Nanos stopped() const { return m_stopped; }

 private:
  void count(Nanos passed, const std::optional<ProcessRunState>& look);

  Nanos m_passed{0};
  Nanos m_counted{0};
  Nanos m_own{0};
  Nanos m_stopped{0};
  std::optional<Nanos> m_cpu;  ///< ProcessRunState::cpu at the last look
};

/// Finds the first tick that a game's own code, and not the load of the machine, makes longer than a frame.
/// The thread that ticks calls beginTick(); one other thread may call check().
class SlowTickDetector {
 public:
  using Nanos = std::chrono::nanoseconds;

  /// Call when a tick begins in this process.
  void beginTick(pid_t process);
  /// Returns a line for the log, once, if `passed`, the time since the tick began, exceeds `frame`, and the
  /// process has computed for half a frame or waits for something. `activity`: the running handler, as of
  /// describeActivity(); without one, and in tick 1, which may load files, there is no line.
  std::string check(pid_t process, std::uint64_t tick, Nanos passed, Nanos frame, std::string_view activity);

 private:
  std::atomic<bool> m_reported = false;
  std::atomic<Nanos::rep> m_cpu = 0;  ///< processor time of the process when the tick began
};

}  // namespace naiad
