// How many lines of chat a client may send now.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace naiad {

class ChatAllowance {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr int kPerSecond = 3;
  /// Lines at once from a client that comes back, if it was away long enough to have typed them.
  static constexpr int kAtOnce = 30;

  explicit ChatAllowance(Time now) : m_refilled(now) {}

  /// Once a tick.
  void refill(Time now) {
    if (now - m_refilled < std::chrono::seconds(1)) return;
    m_refilled = now;
    m_lines = std::max(m_lines, kPerSecond);
  }
  /// The client was away for so long: what was typed in that time comes all at once.
  void allowSaved(Time::duration away) {
    const std::int64_t seconds = std::chrono::floor<std::chrono::seconds>(away).count();
    m_lines = static_cast<int>(std::min<std::int64_t>(kPerSecond * (seconds + 1), kAtOnce));
  }
  /// False if the line is one too many.
  bool takeLine() {
    if (m_lines <= 0) return false;
    --m_lines;
    return true;
  }

 private:
  int m_lines = kPerSecond;
  Time m_refilled;
};

}  // namespace naiad
