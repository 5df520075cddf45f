// Judges how long the tick takes: is the game hanging, and may the server still end in order?
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace naiad {

/// Single-threaded. Time is passed in.
class HangWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// After this time in one tick the game counts as hanging.
  static constexpr std::chrono::seconds kHang{1};
  /// A server that is to end waits so long for a tick, and so long after the signal.
  static constexpr std::chrono::seconds kTickBeforeEnd{3};
  static constexpr std::chrono::seconds kSignalBeforeEnd{1};

  enum class Step {
    kNothing,
    kReport,     ///< the game hangs: once for each tick
    kEndHung,    ///< end without the game: it is asked for, and the tick does not finish
    kEndAtOnce,  ///< end without the game: it was asked for twice
  };

  /// `tick` and `since`: of the tick that is running, if one is. `stops`: signals so far that ask for the
  /// end.
  Step check(std::optional<std::uint64_t> tick, Time since, int stops, Time now) {
    if (stops > 0 && !m_asked_at) m_asked_at = now;
    if (stops > 1) return Step::kEndAtOnce;
    if (!tick) return Step::kNothing;
    if (m_asked_at && now - since >= kTickBeforeEnd && now - *m_asked_at >= kSignalBeforeEnd)
      return Step::kEndHung;
    if (now - since < kHang || m_reported == tick) return Step::kNothing;
    m_reported = tick;
    return Step::kReport;
  }

 private:
  std::optional<Time> m_asked_at;
  std::optional<std::uint64_t> m_reported;
};

}  // namespace naiad
