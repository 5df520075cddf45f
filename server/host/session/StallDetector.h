// Does the other end of a stream still take in what it is sent?
#pragma once

#include <chrono>
#include <cstddef>

namespace naiad {

/// A stream is stuck if more than kMuch is unsent and that has not become less for kPatience. A slow stream
/// is not: each new minimum restarts the time. Pure.
class StallDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMuch = std::size_t{64} * 1024;  ///< bytes
  static constexpr std::chrono::seconds kPatience{10};

  /// At `now` the stream has so many bytes unsent. True if it is stuck.
  bool addSample(std::size_t unsent, Time now) {
    if (unsent <= kMuch || m_least == 0 || unsent < m_least) {
      m_least = unsent <= kMuch ? 0 : unsent;
      m_since = now;
      return false;
    }
    return now - m_since >= kPatience;
  }
  /// Another stream.
  void restart() { m_least = 0; }

 private:
  std::size_t m_least = 0;  ///< the minimum since more than kMuch was unsent; 0: no more than that is
  Time m_since{};
};

}  // namespace naiad
