// How many lines of chat a client may send now.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

/// One for a session, whatever becomes of its streams: only time refills it. Time is passed in.
class ChatAllowance {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr double kPerSecond = 3;
  static constexpr double kAtOnce = 3;
  /// Lines at once from a client that comes back, if it was silent long enough to have typed them.
  static constexpr double kSaved = 30;

  explicit ChatAllowance(Time now) : m_refilled(now) {}

  /// False if the line is one too many.
  bool takeLine(Time now) {
    refill(now, kAtOnce);
    if (m_lines < 1) return false;
    m_lines -= 1;
    return true;
  }
  /// The client is back, on another stream, and nothing had come since `silent_since`: what was typed
  /// meanwhile comes all at once.
  void refillAfterSilence(Time silent_since, Time now) {
    refill(silent_since, kAtOnce);
    refill(now, kSaved);
  }

 private:
  /// Up to `most` lines; if there are more, they stay.
  void refill(Time now, double most) {
    if (now <= m_refilled) return;
    const double seconds = std::chrono::duration<double>(now - m_refilled).count();
    m_refilled = now;
    if (m_lines < most) m_lines = std::min(most, m_lines + seconds * kPerSecond);
  }

  double m_lines = kAtOnce;
  Time m_refilled;
};

}  // namespace naiad
