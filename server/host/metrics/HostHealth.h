// The health and readiness of a host. The tick thread writes it; the metrics thread reads it for /healthz and
// /readyz, because a tick thread that hangs cannot answer.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "host/process/StageClock.h"

namespace naiad {

/// Returns the stage's name in metrics, like "idle" or "receive".
const char* nameOf(Stage stage);

/// Any thread may call health() and readiness(); only the tick thread may call the others. Time is a
/// parameter.
class HostHealth {
 public:
  using Clock = std::chrono::steady_clock;

  /// If no tick begins for this long (one second or ten ticks, whichever is more), the host counts as hung.
  static constexpr std::chrono::nanoseconds kMinHangTime = std::chrono::seconds(1);
  static constexpr int kHangTicks = 10;

  /// `stages` has the time of the newest tick and the current stage; it must outlive this.
  explicit HostHealth(const StageClock& stages) : m_stages(stages) {}

  /// Call it when the host listens and its ticks begin. `tick_length`: their length.
  void begin(std::chrono::nanoseconds tick_length, Clock::time_point now);
  /// Sets whether the maximum number of players is reached.
  void setFull(bool full) { m_full.store(full, std::memory_order_relaxed); }
  /// Call when the host accepts no more players. `ticks`: true if it still ticks; health() then still reports
  /// a hang.
  void beginDrain(bool ticks);
  /// Call it if the end is cancelled: the host accepts players again.
  void cancelDrain() { m_phase = Phase::kRunning; }

  /// The response to a health check: status 200 if good, else 503.
  struct Result {
    bool is_good = true;
    std::string sentence;
  };
  /// Returns whether ticks begin in time.
  Result health(Clock::time_point now) const;
  /// Returns whether new players can join: not while the host starts, is full, drains, ends or hangs.
  Result readiness(Clock::time_point now) const;

 private:
  enum class Phase : std::uint8_t { kStarting, kRunning, kDraining, kEnding };

  const StageClock& m_stages;
  std::atomic<Phase> m_phase = Phase::kStarting;
  std::atomic<Clock::rep> m_began = 0;        ///< time of begin()
  std::atomic<std::int64_t> m_hang_time = 0;  ///< nanoseconds without a new tick that mean a hung host
  std::atomic<bool> m_full = false;
};

}  // namespace naiad
