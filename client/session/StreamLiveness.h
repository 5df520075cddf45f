// Whether the server is still there: how long it has been silent, and how long pings take on the stream.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/IdleTimer.h"
#include "shared/net/base/LinkStats.h"

namespace naiad {

class StreamLiveness {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = LinkStats::Millis;

  static constexpr std::chrono::seconds kPingInterval{1};
  /// Interval of pings while datagrams pass, which measure the round trip, too.
  static constexpr std::chrono::seconds kSeldomPing{5};
  /// A stream on which a ping stays unanswered for so long is taken to be dead.
  static constexpr std::chrono::seconds kStreamSilence{10};

  explicit StreamLiveness(Time now) : m_last_ping(now), m_idle(now) {}

  /// Something arrived from the server, on any path.
  void noteHeard(Time now) { m_idle.heard(now); }
  /// Deadlines are about to be checked (IdleTimer.h).
  void listen(Time now) { m_idle.listen(now); }
  IdleTimer::Duration silence(Time now) const { return m_idle.at(now); }

  /// There is a new stream: pings of the old one are lost, and the next one is due now.
  void startStream(Time now);
  /// No ping of this stream counts any more.
  void forgetPings() { m_pings.clear(); }
  /// Does the oldest ping wait too long? `has_datagrams`: the server is alive, so the stream is
  /// dead.
  bool isStreamDead(Time now, bool has_datagrams) const;
  bool isPingDue(Time now, bool has_datagrams) const;
  /// A ping goes out: its token.
  std::uint64_t startPing(Time now);
  /// Its pong arrived. The time it took; nothing if the token is unknown or its pong has arrived before.
  std::optional<Millis> endPing(std::uint64_t token, Time now);
  /// A round trip measured with datagrams.
  void noteRoundTrip(Millis sample, Time now) { m_stats.addSample(sample, now); }
  /// Smoothed, in whole milliseconds, rounded up: less than one is a measurement, too. Zero before the first.
  std::chrono::milliseconds roundTrip() const;

 private:
  std::map<std::uint64_t, Time> m_pings;  ///< unanswered, by token
  std::uint64_t m_next_token = 1;
  LinkStats m_stats;
  Time m_last_ping;
  IdleTimer m_idle;
};

}  // namespace naiad
