// A thread that watches the one that ticks: a game that never returns from a handler keeps that one from
// noticing anything.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "host/process/StopSignals.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// How a server ends without its game.
struct ForcedEnd {
  bool hung = false;       ///< the tick did not finish; else there was a second signal
  std::uint64_t tick = 0;  ///< the tick that did not finish; 0: none was running
  int signal = 0;          ///< that asked for it
};

class Watchdog {
 public:
  /// Watches `signals` and the ticks that are reported to it, until it is destroyed. `end` ends the process;
  /// it is called on the watching thread, and does not return. `log` is called there, too, and must not wait
  /// for anything the game may hold (SideLog.h).
  Watchdog(const StopSignals& signals, LogLine log, std::function<void(const ForcedEnd&)> end);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// On the thread that ticks.
  void beginTick(std::uint64_t number);
  void endTick() { m_since.store(0, std::memory_order_release); }

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  const StopSignals& m_signals;
  LogLine m_log;
  std::function<void(const ForcedEnd&)> m_end;
  std::atomic<std::uint64_t> m_tick = 0;
  std::atomic<Clock::rep> m_since = 0;  ///< when the tick began; 0: none is running
  std::mutex m_mutex;
  std::condition_variable m_changed;
  bool m_stopping = false;
  std::thread m_thread;
};

}  // namespace naiad
