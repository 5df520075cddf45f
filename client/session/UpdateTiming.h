// Timing of a client: when it sends acknowledgements and inputs, whether datagrams pass, whether the server
// is still there. Time is passed in.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/LinkStats.h"

namespace naiad {

/// Tracks whether the server is still there: its silence, and the round trip of pings on the stream.
class StreamLiveness {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = LinkStats::Millis;

  static constexpr std::chrono::seconds kPingInterval{1};
  /// Interval of pings while datagrams pass, because datagrams also measure the round trip.
  static constexpr std::chrono::seconds kSeldomPing{5};
  /// Age of an unanswered ping at which the stream counts as dead while datagrams pass.
  static constexpr std::chrono::seconds kStreamSilence{10};

  explicit StreamLiveness(Time now) : m_last_ping(now), m_idle(now) {}

  /// Call when something arrived from the server, on any path.
  void noteHeard(Time now) { m_idle.heard(now); }
  /// Call before deadlines are checked (IdleTimer).
  void listen(Time now) { m_idle.listen(now); }
  /// Returns how long nothing has been received (IdleTimer).
  IdleTimer::Duration silence(Time now) const { return m_idle.at(now); }

  /// Call for a new stream: forgets the pings of the old one and makes a ping due now.
  void startStream(Time now);
  /// Forgets all unanswered pings.
  void forgetPings() { m_pings.clear(); }
  /// True if the oldest ping has waited for kStreamSilence although datagrams show that the server is alive.
  bool isStreamDead(Time now, bool has_datagrams) const;
  /// True if it is time for startPing().
  bool isPingDue(Time now, bool has_datagrams) const;
  /// Call when sending a ping. Returns its token.
  std::uint64_t startPing(Time now);
  /// Call when a pong arrives. Returns the round trip; nullopt if the token is unknown or already answered.
  std::optional<Millis> endPing(std::uint64_t token, Time now);
  /// Adds a round trip measured with datagrams.
  void noteRoundTrip(Millis sample, Time now) { m_stats.addSample(sample, now); }
  /// Returns the smoothed round trip in whole milliseconds, rounded up. Zero before the first measurement.
  std::chrono::milliseconds roundTrip() const;

 private:
  std::map<std::uint64_t, Time> m_pings;  ///< unanswered, by token
  std::uint64_t m_next_token = 1;
  LinkStats m_stats;
  Time m_last_ping;
  IdleTimer m_idle;
};

/// Decides when acknowledgements and inputs are sent, and whether datagrams pass.
class UpdateTiming {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time after a datagram for which datagrams count as passing.
  static constexpr std::chrono::milliseconds kPassing = PathProbe::kOpenFor;
  /// Time without datagrams after which a second stream is worth opening.
  static constexpr std::chrono::milliseconds kOnStreamOnly{3000};
  /// Unusual pause between datagrams: the server may have lost the client's address.
  static constexpr std::chrono::milliseconds kQuiet{400};
  /// Time after a snapshot on the stream during which the server may not be receiving datagrams.
  static constexpr std::chrono::milliseconds kUndecided{500};
  static constexpr std::chrono::milliseconds kRepeatInput{10};  ///< delay before an input is sent again
  static constexpr int kAckEvery = 3;                           ///< snapshots per acknowledgement
  static constexpr std::chrono::milliseconds kAckDelay{50};     ///< maximum delay of an acknowledgement
  static constexpr std::chrono::milliseconds kPingEvery{1000};  ///< interval of pings by datagram

  /// Call when the session has a stream, the first or another one.
  void noteAttached(Time now) { m_probe.renew(now); }
  void noteDatagram(Time now) { m_probe.addEvidence(now); }
  void noteStreamSnapshot(Time now) { m_last_streamed = now; }
  /// Call when a datagram is sent. Returns true if it should carry a ping.
  bool noteDatagramSent(Time now);
  /// Call when an update is sent, on any path.
  void noteUpdateSent();
  /// Call for a new input.
  void noteInput(Time now) { m_repeat_at = now + kRepeatInput; }
  /// Call when a snapshot was applied. `gap`: the one before it is missing. Returns true if it should be
  /// acknowledged immediately: every third one, or one after a gap.
  bool noteSnapshotApplied(bool gap, Time now);

  /// True if datagrams arrive.
  bool hasDatagrams(Time now) const { return m_probe.isOpen(now); }
  /// True if the server has just sent a snapshot on the stream: it may not receive datagrams.
  bool isUndecided(Time now) const { return now - m_last_streamed < kUndecided; }
  /// True if datagrams have not passed for kOnStreamOnly, so that snapshots come on the stream.
  bool isOnStreamOnly(Time now) const {
    return isUndecided(now) && now - m_probe.lastChange() >= kOnStreamOnly;
  }
  /// True if it is time to test whether datagrams pass. `only`: there is no stream.
  bool isProbeDue(Time now, bool only = false) const { return m_probe.isDue(now, only); }
  bool isAckDue(Time now) const { return m_acknowledge_at && now >= *m_acknowledge_at; }
  /// Returns true, once, when new inputs should be sent again.
  bool takeRepeat(Time now);
  /// Returns when an input repeat or acknowledgement is due; nullopt if none is.
  std::optional<Time> nextWake() const;

 private:
  PathProbe m_probe{kQuiet};
  Time m_last_streamed{};
  Time m_last_ping{};        ///< last ping by datagram
  int m_unacknowledged = 0;  ///< number of snapshots
  std::optional<Time> m_acknowledge_at;
  std::optional<Time> m_repeat_at;
};

}  // namespace naiad
