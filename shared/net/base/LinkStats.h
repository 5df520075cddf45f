// The round trip of a link: smoothed, and the shortest of late. Time is passed in.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

class LinkStats {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  /// Half of the window of shortest().
  static constexpr std::chrono::seconds kShortestAge{5};

  void addSample(Millis sample, Time now) {
    m_smoothed = m_smoothed.count() == 0 ? sample : m_smoothed + (sample - m_smoothed) / 8;
    if (now - m_shortest_since >= kShortestAge) {
      m_shortest_before = m_shortest;
      m_shortest = sample;
      m_shortest_since = now;
    }
    m_shortest = std::min(m_shortest, sample);
  }

  /// 0 before the first sample.
  Millis smoothed() const { return m_smoothed; }
  /// The shortest sample of about the last ten seconds; very long before the first.
  Millis shortest() const { return std::min(m_shortest, m_shortest_before); }

 private:
  Millis m_smoothed{0};
  Millis m_shortest{1e9};
  Millis m_shortest_before{1e9};
  Time m_shortest_since{};
};

}  // namespace naiad
