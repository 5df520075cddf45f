// Measurements of a link by one of its ends: the round trip, silence, whether datagrams pass. They read no
// clock: callers pass the time.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

/// Finds out whether datagrams pass on the current path, and when to probe it. Each end has one.
///
/// Evidence that they pass is, for a server, that a datagram acknowledges an earlier datagram; for a client,
/// any datagram.
class PathProbe {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::milliseconds;

  static constexpr Millis kOpenTime{1000};          ///< time for which the path counts as open after evidence
  static constexpr Millis kProbeInterval{1000};     ///< interval of probes if neither of the next two applies
  static constexpr Millis kFastProbeInterval{100};  ///< interval while the path is open, and for a second
                                                    ///< after construction or renew()
  /// Interval of probes until kEagerTime after the last evidence, or always if datagrams are the only way to
  /// the other end. On a line that loses most packets, one probe a second is rarely acknowledged.
  static constexpr Millis kEagerProbeInterval{250};
  static constexpr std::chrono::seconds kEagerTime{10};

  /// Probes are due until the first evidence, and whenever there was none for `quiet`.
  explicit PathProbe(Millis quiet, Time now = {}) : m_quiet(quiet), m_began(now) {}

  /// Call after a change of address or stream: due probes have the shortest interval for a second again.
  void renew(Time now) { m_began = now; }
  void addEvidence(Time now) {
    m_passed = true;
    m_last_evidence = now;
  }
  void probeSent(Time now) { m_last_probe = now; }

  bool isOpen(Time now) const { return m_passed && now - m_last_evidence < kOpenTime; }
  /// True if a probe is due. `only`: datagrams are the only way to the other end.
  bool isDue(Time now, bool only) const {
    const bool quiet = !m_passed || now - m_last_evidence >= m_quiet;
    return quiet && now - m_last_probe >= interval(now, only);
  }
  /// The time of the last evidence, or of the last renew() (at first, of construction) if that was later.
  Time lastChange() const { return m_last_evidence > m_began ? m_last_evidence : m_began; }

 private:
  Millis interval(Time now, bool only) const {
    if (now - m_began < kOpenTime || isOpen(now)) return kFastProbeInterval;
    return only || (m_passed && now - m_last_evidence < kEagerTime) ? kEagerProbeInterval : kProbeInterval;
  }

  Millis m_quiet;
  Time m_began;
  Time m_last_evidence{};
  Time m_last_probe{};
  bool m_passed = false;
};

/// Measures how long the other end of a line has been silent while this end listened.
///
/// A process that gets no CPU time receives nothing, and afterwards the bytes that arrived still wait to be
/// read. Therefore time counts as silence only while this end calls poll().
class IdleTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = Time::duration;

  /// At most this much of the time between two poll() calls counts as silence.
  static constexpr std::chrono::milliseconds kMaxAtOnce{500};

  explicit IdleTimer(Time now) : m_since(now), m_polled(now) {}

  /// Records that something was received.
  void onActivity(Time now) { m_since = now; }
  /// Call before checking deadlines, a few times a second.
  void poll(Time now) {
    const Duration away = now - m_polled - kMaxAtOnce;
    if (away > Duration::zero()) m_since = std::min(m_since + away, now);
    m_polled = std::max(m_polled, now);
  }
  /// Returns the length of the silence.
  Duration idleTime(Time now) const { return now - m_since; }

 private:
  Time m_since;
  Time m_polled;
};

/// The round-trip time: smoothed, and the shortest recent one.
class LinkStats {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  /// Half of the time window of shortest().
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

  /// The smoothed round trip; 0 before the first sample.
  Millis smoothed() const { return m_smoothed; }
  /// The shortest sample of about the last ten seconds; very long before the first one.
  Millis shortest() const { return std::min(m_shortest, m_shortest_before); }

 private:
  Millis m_smoothed{0};
  Millis m_shortest{1e9};
  Millis m_shortest_before{1e9};
  Time m_shortest_since{};
};

}  // namespace naiad
