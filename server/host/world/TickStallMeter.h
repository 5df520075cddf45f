// Measures how long a world itself has delayed a tick, to tell whether its game hangs.
//
// On a loaded machine a process may have to wait for a processor, and in a debugger it does nothing. Neither
// is the game's fault, so only computing, and waiting for something that the game asked for, counts in full.
// A process stopped by a signal has longer, but not unlimited time: it may have sent that signal itself.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace naiad {

/// The state of a process, as the kernel reports it.
struct ProcessRunState {
  enum Doing {
    kRuns,      ///< it computes, waits for a processor, or waits for a disk
    kWaits,     ///< it waits for something it asked for: a time, a lock, bytes
    kStopped,   ///< stopped by a signal
    kDebugged,  ///< stopped by a debugger, which a sandboxed world cannot be itself
  } doing = kRuns;
  std::chrono::nanoseconds cpu{0};  ///< processor time of all its threads since its start
};

/// Returns the state of a process; nullopt if it does not exist, or the kernel does not say.
std::optional<ProcessRunState> readProcessRunState(pid_t process);

/// Adds up the time of one tick. Time is passed in.
class TickStallMeter {
 public:
  using Nanos = std::chrono::nanoseconds;

  /// Time of a tick that counts in full, without a look at the process.
  static constexpr Nanos kUninspectedTime = std::chrono::milliseconds(50);
  /// One part in this many of the time in which a process is stopped, or waits for a processor, counts. If
  /// none did, it would be waited for without end.
  static constexpr int kStarvedPart = 10;

  /// Begins another tick.
  void restart() { *this = TickStallMeter(); }
  /// Adds the time `passed` since the last call. `look` returns the state of the process, and is called once
  /// the tick takes longer than kUninspectedTime.
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
  /// Returns the time that counts.
  Nanos counted() const { return m_counted; }
  /// Returns the part of it that no load, signal or debugger can have caused: computing, and waiting for
  /// something.
  Nanos own() const { return m_own; }
  /// Returns how long it has been stopped.
  Nanos stopped() const { return m_stopped; }

 private:
  void count(Nanos passed, const std::optional<ProcessRunState>& look);

  Nanos m_passed{0};
  Nanos m_counted{0};
  Nanos m_own{0};
  Nanos m_stopped{0};
  std::optional<Nanos> m_cpu;  ///< ProcessRunState::cpu at the last look
};

}  // namespace naiad
