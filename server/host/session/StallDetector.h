// Does the other end of a stream still take in what it is sent?
#pragma once

#include <chrono>
#include <cstddef>

namespace naiad {

/// A stream with more than kMuch unsent that for kPatience has not come nearer to its end has stuck. Slow is
/// no crime: each byte less than ever since the pile began starts the time anew. Pure.
class StallDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMuch = std::size_t{64} * 1024;  ///< bytes
  static constexpr std::chrono::seconds kPatience{10};

  /// At `now` the stream has so many bytes unsent. True if it has stuck.
  bool note(std::size_t unsent, Time now) {
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
  std::size_t m_least = 0;  ///< bytes unsent, at least, since there were too many; 0: there are not
  Time m_since{};
};

}  // namespace naiad
