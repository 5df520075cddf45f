// How long a world has kept a tick waiting by what it does itself: the measure of a game that hangs.
//
// On a machine under load a process that would run does not get to; one in a debugger does nothing at all.
// Neither is the game's fault, and neither counts: only what it computes, and the time that it waits for
// something of its own. One that a signal has stopped has longer, but not for ever: it may have sent that
// signal itself.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace naiad {

/// What a process is doing, as the kernel says.
struct ProcessLook {
  enum Doing {
    kRuns,      ///< it computes, would do so, or waits for a disk
    kWaits,     ///< for something that it asked for: a time, a lock, bytes
    kStopped,   ///< by a signal
    kDebugged,  ///< stopped by a debugger, which a world in its sandbox cannot be its own
  } doing = kRuns;
  std::chrono::nanoseconds cpu{0};  ///< of all its threads, since its start
};

/// Nothing if there is no such process, or the kernel does not say.
std::optional<ProcessLook> lookAtProcess(pid_t process);

/// Of one tick. Time is passed in.
class TickEffort {
 public:
  using Nanos = std::chrono::nanoseconds;

  /// Ticks that end sooner are not looked into: all of it counts.
  static constexpr Nanos kUnseen = std::chrono::milliseconds(50);
  /// Of the time in which a process would run and does not get to, or is stopped, so much counts: one part in
  /// ten. It would be waited for without end else.
  static constexpr int kStarvedPart = 10;

  /// Another tick.
  void restart() { *this = TickEffort(); }
  /// `passed` since the last call; `look` says what the process does now, and is called once the tick takes
  /// longer than kUnseen.
  template <class Look>
  void add(Nanos passed, Look look) {
    m_passed += passed;
    if (m_passed <= kUnseen) {
      m_counted += passed;
      m_own += passed;
    } else {
      count(passed, look());
    }
  }
  /// What counts.
  Nanos counted() const { return m_counted; }
  /// The part of it that no load, signal or debugger can have caused: computing, and waiting for something.
  Nanos own() const { return m_own; }
  /// For how long it has been stopped.
  Nanos stopped() const { return m_stopped; }

 private:
  void count(Nanos passed, const std::optional<ProcessLook>& look);

  Nanos m_passed{0};
  Nanos m_counted{0};
  Nanos m_own{0};
  Nanos m_stopped{0};
  std::optional<Nanos> m_cpu;  ///< at the last look
};

}  // namespace naiad
