// Timing of a client: when it sends acknowledgements and inputs, whether datagrams pass, whether the server
// still answers. The caller passes the time.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/LinkStats.h"

namespace naiad {

/// Tracks whether the server still answers: its silence, and the round trip of pings on the stream.
class StreamLiveness {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = LinkStats::Millis;

  static constexpr std::chrono::seconds kPingInterval{1};
  /// Interval of pings while datagrams pass, because datagrams also measure the round trip.
  static constexpr std::chrono::seconds kSlowPingInterval{5};
  /// Age of an unanswered ping at which the stream counts as dead while datagrams pass.
  static constexpr std::chrono::seconds kStreamTimeout{10};

  explicit StreamLiveness(Time now) : m_last_ping(now), m_idle(now) {}

  /// Call when something arrived from the server, except on a second stream.
  void onReceived(Time now) { m_idle.onActivity(now); }
  /// Call before deadlines are checked (IdleTimer).
  void poll(Time now) { m_idle.poll(now); }
  /// Returns how long nothing has been received (IdleTimer).
  IdleTimer::Duration silence(Time now) const { return m_idle.idleTime(now); }

  /// Call for a new stream: forgets the pings of the old one and makes a ping due now.
  void startStream(Time now);
  void forgetPings() { m_pings.clear(); }
  /// True if the oldest ping has waited for kStreamTimeout although datagrams show that the server is alive.
  bool isStreamDead(Time now, bool has_datagrams) const;
  /// True if it is time for startPing().
  bool isPingDue(Time now, bool has_datagrams) const;
  /// Call when sending a ping. Returns its token.
  std::uint64_t startPing(Time now);
  /// Call when a pong arrives. Adds and returns the round trip; nullopt if no unanswered ping has the token.
  std::optional<Millis> endPing(std::uint64_t token, Time now);
  /// Adds a round trip measured with datagrams.
  void addRttSample(Millis sample, Time now) { m_stats.addSample(sample, now); }
  /// Returns the smoothed round trip in milliseconds, rounded up, at most 99,999; zero before a measurement.
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

  /// Time after the last received datagram during which datagrams count as passing.
  static constexpr std::chrono::milliseconds kDatagramTimeout = PathProbe::kOpenTime;
  /// Time without received datagrams after which a second stream is worth opening.
  static constexpr std::chrono::milliseconds kSecondStreamDelay{3000};
  /// Time without received datagrams after which a probe is sent, because the server may have lost the
  /// client's address.
  static constexpr std::chrono::milliseconds kProbeDelay{400};
  /// Time after a snapshot on the stream in which the client assumes that its datagrams may not arrive.
  static constexpr std::chrono::milliseconds kUndecidedWindow{500};
  static constexpr std::chrono::milliseconds kInputResendDelay{10};  ///< delay before an input is sent again
  static constexpr int kSnapshotsPerAck = 3;                         ///< snapshots per acknowledgement
  static constexpr std::chrono::milliseconds kAckDelay{50};          ///< maximum delay of an acknowledgement
  static constexpr std::chrono::milliseconds kDatagramPingInterval{1000};  ///< interval of pings by datagram

  /// Call when the session has a stream, the first or another one.
  void onAttached(Time now) { m_probe.renew(now); }
  void onDatagram(Time now) { m_probe.addEvidence(now); }
  void onStreamSnapshot(Time now) { m_last_streamed = now; }
  /// Call when a datagram is sent. Returns true if it should carry a ping.
  bool onDatagramSent(Time now);
  /// Call when an update is sent, on any path.
  void onUpdateSent();
  void onInput(Time now) { m_resend_at = now + kInputResendDelay; }
  /// Call when a snapshot was applied. `gap`: the one before it is missing. Returns true if it should be
  /// acknowledged immediately: every third one, or one after a gap.
  bool onSnapshotApplied(bool gap, Time now);

  bool hasDatagrams(Time now) const { return m_probe.isOpen(now); }
  /// True if the server has just sent a snapshot on the stream: it may not receive datagrams.
  bool isUndecided(Time now) const { return now - m_last_streamed < kUndecidedWindow; }
  /// True if the server has just sent a snapshot on the stream, and for kSecondStreamDelay no datagram has
  /// arrived and no new stream has begun.
  bool isOnStreamOnly(Time now) const {
    return isUndecided(now) && now - m_probe.lastChange() >= kSecondStreamDelay;
  }
  /// True if it is time to test whether datagrams pass. `only`: there is no stream.
  bool isProbeDue(Time now, bool only = false) const { return m_probe.isDue(now, only); }
  bool isAckDue(Time now) const { return m_acknowledge_at && now >= *m_acknowledge_at; }
  /// Returns true, once, when new inputs should be sent again.
  bool popInputResend(Time now);
  /// Returns when an input repeat or acknowledgement is due; nullopt if none is.
  std::optional<Time> nextWake() const;

 private:
  PathProbe m_probe{kProbeDelay};
  Time m_last_streamed{};
  Time m_last_ping{};        ///< time of the last ping by datagram
  int m_unacknowledged = 0;  ///< number of snapshots since the last update
  std::optional<Time> m_acknowledge_at;
  std::optional<Time> m_resend_at;
};

}  // namespace naiad
