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
  std::uint64_t startPing(Time now);
  /// Its pong arrived. The time it took; nothing if the token is unknown or its pong has arrived before.
  std::optional<Millis> endPing(std::uint64_t token, Time now);
  /// A round trip measured by other means.
  void addSample(Millis sample, Time now) { m_stats.addSample(sample, now); }
  /// Another stream: open pings are lost.
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
