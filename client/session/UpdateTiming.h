// What a client times: when it sends acknowledgements and inputs, whether datagrams pass, whether the server
// is still there. Pure: time is passed in.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/LinkStats.h"

namespace naiad {

/// Whether the server is still there: how long it has been silent, and how long pings take on the stream.
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
  /// Deadlines are about to be checked (IdleTimer).
  void listen(Time now) { m_idle.listen(now); }
  /// Returns how long nothing has been received (IdleTimer).
  IdleTimer::Duration silence(Time now) const { return m_idle.at(now); }

  /// There is a new stream: pings of the old one are lost, and the next one is due now.
  void startStream(Time now);
  /// No ping of this stream counts any more.
  void forgetPings() { m_pings.clear(); }
  /// Does the oldest ping wait too long? `has_datagrams`: the server is alive, so the stream is
  /// dead.
  bool isStreamDead(Time now, bool has_datagrams) const;
  /// True if it is time for startPing().
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

/// When acknowledgements and inputs are sent, and whether datagrams pass.
class UpdateTiming {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kPassing = PathProbe::kOpenFor;  ///< after a datagram
  /// After so long without datagrams a second stream is worth opening.
  static constexpr std::chrono::milliseconds kOnStreamOnly{3000};
  /// So long without a datagram is unusual: the server may have lost the client's address.
  static constexpr std::chrono::milliseconds kQuiet{400};
  /// For so long after a snapshot on the stream it is undecided whether the server receives datagrams.
  static constexpr std::chrono::milliseconds kUndecided{500};
  static constexpr std::chrono::milliseconds kRepeatInput{10};  ///< a new input is sent again after this
  static constexpr int kAckEvery = 3;                           ///< snapshots
  static constexpr std::chrono::milliseconds kAckDelay{50};     ///< of the last one, at most
  static constexpr std::chrono::milliseconds kPingEvery{1000};  ///< by datagram

  /// The session has a stream, the first or another one.
  void noteAttached(Time now) { m_probe.renew(now); }
  void noteDatagram(Time now) { m_probe.addEvidence(now); }
  void noteStreamSnapshot(Time now) { m_last_streamed = now; }
  /// A datagram is sent, with an update. True if it is to carry a ping.
  bool noteDatagramSent(Time now);
  /// An update is sent, on any path.
  void noteUpdateSent();
  /// There is a new input.
  void noteInput(Time now) { m_repeat_at = now + kRepeatInput; }
  /// A snapshot was applied. `gap`: the one before it is missing. True if it is to be
  /// acknowledged immediately: every third one, or one after a gap.
  bool noteSnapshotApplied(bool gap, Time now);

  /// Do datagrams arrive?
  bool hasDatagrams(Time now) const { return m_probe.isOpen(now); }
  /// The server sent on the stream just now: it may not receive datagrams.
  bool isUndecided(Time now) const { return now - m_last_streamed < kUndecided; }
  /// Everything has come on the stream for a while, since datagrams do not pass.
  bool isOnStreamOnly(Time now) const {
    return isUndecided(now) && now - m_probe.lastChange() >= kOnStreamOnly;
  }
  /// It is time to test whether they pass. `only`: there is no stream.
  bool isProbeDue(Time now, bool only = false) const { return m_probe.isDue(now, only); }
  bool isAckDue(Time now) const { return m_acknowledge_at && now >= *m_acknowledge_at; }
  /// True once when new inputs should be sent again.
  bool takeRepeat(Time now);
  /// When one of these will be due before the usual time; nothing if none will.
  std::optional<Time> nextWake() const;

 private:
  PathProbe m_probe{kQuiet};
  Time m_last_streamed{};
  Time m_last_ping{};        ///< by datagram
  int m_unacknowledged = 0;  ///< snapshots
  std::optional<Time> m_acknowledge_at;
  std::optional<Time> m_repeat_at;
};

}  // namespace naiad
