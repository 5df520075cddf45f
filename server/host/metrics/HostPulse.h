// Is the host alive, and does it take players? Written by the thread that ticks, read by the one that answers
// /healthz and /readyz: a host that hangs cannot answer for itself.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "host/process/StageClock.h"

namespace naiad {

/// As in the metric's label: "between", "receive", ….
const char* nameOf(Stage stage);

/// Writers are for the thread that ticks, health() and readiness() for any. Time is passed in.
class HostPulse {
 public:
  using Clock = std::chrono::steady_clock;

  /// A tick that is later than this has not begun because the host hangs: a second, or ten ticks.
  static constexpr std::chrono::nanoseconds kLeastPatience = std::chrono::seconds(1);
  static constexpr int kPatienceTicks = 10;

  /// `stages`: ticks that begin, and in which stage a host hangs; outlives this.
  explicit HostPulse(const StageClock& stages) : m_stages(stages) {}

  /// Listening, and ticks of this length begin.
  void begin(std::chrono::nanoseconds tick_length, Clock::time_point now);
  /// All places are taken, or no longer.
  void setFull(bool full) { m_full.store(full, std::memory_order_relaxed); }
  /// It takes no more players and is about to end; `ticks`: as long as it ticks it can hang.
  void beginDrain(bool ticks);
  /// It does not end after all.
  void cancelDrain() { m_phase = Phase::kRunning; }

  /// What is answered: with 200 if it is good, else with 503.
  struct Verdict {
    bool is_good = true;
    std::string sentence;
  };
  /// Do ticks begin?
  Verdict health(Clock::time_point now) const;
  /// May players come?
  Verdict readiness(Clock::time_point now) const;

 private:
  enum class Phase : std::uint8_t { kStarting, kRunning, kDraining, kEnding };

  const StageClock& m_stages;
  std::atomic<Phase> m_phase = Phase::kStarting;
  std::atomic<Clock::rep> m_began = 0;       ///< when ticks were to begin
  std::atomic<std::int64_t> m_patience = 0;  ///< in nanoseconds
  std::atomic<bool> m_full = false;
};

}  // namespace naiad
