// Whether datagrams pass on the current path, and when to probe it. Both ends run one. Time is passed in.
//
// Evidence is what only a datagram can bring: to a server an acknowledgement of a datagram by a datagram, to
// a client any datagram.
#pragma once

#include <chrono>

namespace naiad {

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

}  // namespace naiad
