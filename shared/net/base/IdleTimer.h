// How long the other end of a line has been silent while this end listened.
//
// A process that gets no processor hears nothing, and when it goes on, what came in the meantime still waits
// to be read. So time counts as silence only as far as this end looked at the clock in it.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

class IdleTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = Time::duration;

  /// Of the time between two calls of listen() no more than this counts.
  static constexpr std::chrono::milliseconds kMaxAtOnce{500};

  explicit IdleTimer(Time now) : m_since(now), m_listened(now) {}

  /// Something came.
  void heard(Time now) { m_since = now; }
  /// This end is about to look at deadlines, which it should do a few times a second.
  void listen(Time now) {
    const Duration away = now - m_listened - kMaxAtOnce;
    if (away > Duration::zero()) m_since = std::min(m_since + away, now);
    m_listened = std::max(m_listened, now);
  }
  /// How long it has lasted.
  Duration at(Time now) const { return now - m_since; }

 private:
  Time m_since;
  Time m_listened;
};

}  // namespace naiad
