// What an end of a link finds out about it: the round trip, silence, whether datagrams pass. Time is passed
// in.
#pragma once

#include <algorithm>
#include <chrono>

namespace naiad {

/// Whether datagrams pass on the current path, and when to probe it. Both ends run one.
///
/// Evidence is what only a datagram can bring: to a server an acknowledgement of a datagram by a datagram, to
/// a client any datagram.
class PathProbe {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::milliseconds;

  static constexpr Millis kOpenFor{1000};     ///< after evidence
  static constexpr Millis kProbeEvery{1000};  ///< while datagrams do not pass
  static constexpr Millis kFirstProbes{100};  ///< in the first second of a session or path, and while open
  /// While datagrams passed a moment ago, or there is no other way: on a line that loses most, one probe a
  /// second hardly ever gets through and its acknowledgement back.
  static constexpr Millis kEagerProbes{250};
  static constexpr std::chrono::seconds kEagerFor{10};

  /// Probes are due after `quiet` without evidence.
  explicit PathProbe(Millis quiet, Time now = {}) : m_quiet(quiet), m_began(now) {}

  /// Another address or stream: find out again, soon.
  void renew(Time now) { m_began = now; }
  void addEvidence(Time now) {
    m_passed = true;
    m_last_evidence = now;
  }
  void probeSent(Time now) { m_last_probe = now; }

  bool isOpen(Time now) const { return m_passed && now - m_last_evidence < kOpenFor; }
  /// `only`: there is no other way.
  bool isDue(Time now, bool only) const {
    const bool quiet = !m_passed || now - m_last_evidence >= m_quiet;
    return quiet && now - m_last_probe >= interval(now, only);
  }
  /// Of the last evidence, or of the last renew(), whichever came later.
  Time lastChange() const { return m_last_evidence > m_began ? m_last_evidence : m_began; }

 private:
  Millis interval(Time now, bool only) const {
    if (now - m_began < kOpenFor || isOpen(now)) return kFirstProbes;
    return only || (m_passed && now - m_last_evidence < kEagerFor) ? kEagerProbes : kProbeEvery;
  }

  Millis m_quiet;
  Time m_began;
  Time m_last_evidence{};
  Time m_last_probe{};
  bool m_passed = false;
};

/// How long the other end of a line has been silent while this end listened.
///
/// A process that gets no processor hears nothing, and when it goes on, what came in the meantime still waits
/// to be read. So time counts as silence only as far as this end looked at the clock in it.
class IdleTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = Time::duration;

  /// Of the time between two calls of listen() no more than this counts.
  static constexpr std::chrono::milliseconds kMaxAtOnce{500};

  explicit IdleTimer(Time now) : m_since(now), m_listened(now) {}

  /// Something came.
  void heard(Time now) { m_since = now; }
  /// This end is about to look at deadlines, which it should do a few times a second.
  void listen(Time now) {
    const Duration away = now - m_listened - kMaxAtOnce;
    if (away > Duration::zero()) m_since = std::min(m_since + away, now);
    m_listened = std::max(m_listened, now);
  }
  /// How long it has lasted.
  Duration at(Time now) const { return now - m_since; }

 private:
  Time m_since;
  Time m_listened;
};

/// The round trip: smoothed, and the shortest of late.
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
