// When the status is shown over the game, on a terminal that has no room beside it: for a moment after
// joining, and when the line has become bad.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace naiad {

class StatusTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kShown{4000};
  /// A round trip that players feel; it is good again only well below.
  static constexpr std::chrono::milliseconds kBad{250};
  static constexpr std::chrono::milliseconds kGood{150};

  /// For a moment from now on.
  void show(Time now) { m_until = now + kShown; }
  /// The line of a player of this id is so long.
  void update(std::uint32_t player, std::chrono::milliseconds round_trip, Time now) {
    if (m_player != player) show(now);
    m_player = player;
    if (!m_bad && round_trip >= kBad) show(now);
    m_bad = round_trip >= (m_bad ? kGood : kBad);
  }
  bool isShown(Time now) const { return now < m_until; }

 private:
  std::optional<std::uint32_t> m_player;
  bool m_bad = false;
  Time m_until{};
};

}  // namespace naiad
