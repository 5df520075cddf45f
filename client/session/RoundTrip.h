// How long a ping takes there and back on the stream.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/LinkStats.h"

namespace naiad {

class RoundTrip {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  /// A ping goes out: its token.
  std::uint64_t ping(Time now);
  /// The answer came. The time it took; nothing if it was answered before, or made up.
  std::optional<Millis> pong(std::uint64_t token, Time now);
  /// A time that was measured otherwise.
  void note(Millis sample, Time now) { m_stats.addSample(sample, now); }
  /// Another stream: what was under way is lost.
  void forgetPings() { m_open.clear(); }

  /// How long the oldest unanswered ping has been under way; zero if there is none.
  Millis waiting(Time now) const;
  /// Smoothed; zero before the first measurement.
  Millis smoothed() const { return m_stats.smoothed(); }
  /// The same in whole milliseconds, rounded up: less than one is a measurement too.
  std::chrono::milliseconds shown() const;

 private:
  std::map<std::uint64_t, Time> m_open;  ///< unanswered, by token
  std::uint64_t m_next_token = 1;
  LinkStats m_stats;
};

}  // namespace naiad
