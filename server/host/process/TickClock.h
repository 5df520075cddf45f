// Computes when ticks are due: absolute deadlines, 30 a second by default.
#pragma once

#include <chrono>
#include <cstdint>

namespace naiad {

/// Length of a tick as a fraction of nanoseconds, so that 1/30 s is exact.
struct TickLength {
  std::int64_t nanoseconds = 1'000'000'000;
  std::int64_t divisor = 30;

  /// Returns the length of `micros` microseconds; 0 stands for 1/30 s.
  static constexpr TickLength fromMicros(std::int64_t micros) {
    return micros == 0 ? TickLength{} : TickLength{micros * 1000, 1};
  }
  constexpr std::chrono::nanoseconds times(std::int64_t count) const {
    return std::chrono::nanoseconds(count * nanoseconds / divisor);
  }
};

/// Deadlines are counted from one origin, so rounding never adds up. If a tick is late by a whole tick, the
/// schedule starts anew (is re-based), so that lost time is not made up by running faster.
class TickClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit TickClock(Clock::time_point start, TickLength length = {}) : m_origin(start), m_length(length) {}

  /// Returns the time when the next tick is due.
  Clock::time_point deadline() const { return m_origin + m_length.times(m_count); }

  /// Begins a tick at `now`, and advances to the next deadline. Returns true if the schedule was re-based.
  bool beginTick(Clock::time_point now) {
    const bool rebased = now - deadline() >= m_length.times(1);
    if (rebased) {
      m_origin = now;
      m_count = 0;
    }
    ++m_count;
    return rebased;
  }

 private:
  Clock::time_point m_origin;
  TickLength m_length;
  std::int64_t m_count = 0;
};

}  // namespace naiad
