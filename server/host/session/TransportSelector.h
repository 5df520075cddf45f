// Whether a session's snapshots go by datagram or on the stream, and how often: by what is known of the link,
// its round trip and its losses.
//
// A session starts on the stream. Once a second, and at first more often, it sends a snapshot as a datagram;
// when one of those is acknowledged by a datagram, snapshots go as datagrams from then on, until none of them
// has been acknowledged so for a second. (An acknowledgement on the stream would say that datagrams pass in
// one direction only; then the player's keys would get lost.) Pure: time is passed in.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>

#include "shared/net/base/LinkStats.h"
#include "shared/replica/Acks.h"

namespace naiad {

class TransportSelector {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  explicit TransportSelector(Time now) : m_probe(PathProbe::kOpenFor, now) {}

  /// Snapshot `number` was sent, as a datagram or on the stream.
  void noteSent(std::uint32_t number, bool as_datagram, Time now) {
    m_sent[number % kKept] = {number, as_datagram, true, false, now};
    if (as_datagram && !isOpen(now)) m_probe.probeSent(now);
  }
  /// The client acknowledged, by a datagram or on the stream.
  void acknowledge(const AckWindow& acks, bool by_datagram, Time now) {
    // Most of a window was in the one before, which came by the same transport: only what is new in it
    // counts.
    AckWindow& before = m_acked[by_datagram ? 1 : 0];
    const std::uint32_t ahead = acks.newest - before.newest;
    const bool follows = before.newest != 0 && !isNewer(before.newest, acks.newest) && ahead <= 64;
    std::uint64_t fresh = acks.mask;
    if (follows && ahead > 0)
      fresh &= ~((ahead < 64 ? before.mask << ahead : 0) | std::uint64_t{1} << (ahead - 1));
    if (follows && ahead == 0) fresh &= ~before.mask;
    if (before.newest == 0 || !isNewer(before.newest, acks.newest)) before = acks;
    noteArrival(acks.newest, true, by_datagram, now);
    for (; fresh != 0; fresh &= fresh - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(fresh));
      noteArrival(acks.newest - 1 - bit, false, by_datagram, now);
    }
  }
  /// Another address or stream: find out again, soon.
  void renew(Time now) { m_probe.renew(now); }

  /// Do datagrams pass?
  bool isOpen(Time now) const { return m_probe.isOpen(now); }
  /// Is it time to try whether they do? `only`: there is no stream.
  bool wantsProbe(Time now, bool only = false) const { return m_probe.isDue(now, only); }

  /// From sending to acknowledgement, smoothed; 0 before the first.
  Millis roundTrip() const { return m_stats.smoothed(); }
  /// The shortest one of about the last ten seconds.
  Millis shortestRoundTrip() const { return m_stats.shortest(); }

  /// Send in each `interval`-th tick: 1, 2, 3 or 6. More while the line is too full (its queues grow, or it
  /// loses more than 15 %), less again after it was well for five seconds.
  std::uint32_t interval(double loss, Time now) {
    const bool bad = roundTrip() - shortestRoundTrip() > kFullQueue || loss > kMuchLoss;
    if (bad != m_bad) (bad ? m_bad_since : m_good_since) = now;
    m_bad = bad;
    if (bad && now - m_bad_since >= kBadFor && m_rung + 1 < kIntervals.size()) {
      ++m_rung;
      m_bad_since = now;
    }
    if (!bad && now - m_good_since >= kGoodFor && m_rung > 0) {
      --m_rung;
      m_good_since = now;
    }
    return kIntervals[m_rung];
  }

 private:
  static constexpr Millis kFullQueue{50};
  static constexpr double kMuchLoss = 0.15;
  static constexpr std::chrono::seconds kBadFor{1};
  static constexpr std::chrono::seconds kGoodFor{5};

  struct Sent {
    std::uint32_t number = 0;
    bool as_datagram = false;
    bool open = false;       ///< not acknowledged yet
    bool confirmed = false;  ///< a datagram that a datagram acknowledged
    Time at{};
  };
  static constexpr std::size_t kKept = 128;
  static constexpr std::array<std::uint32_t, 4> kIntervals = {1, 2, 3, 6};

  void noteArrival(std::uint32_t number, bool newest, bool by_datagram, Time now) {
    Sent& sent = m_sent[number % kKept];
    if (sent.number != number || number == 0) return;
    if (sent.open && newest) m_stats.addSample(now - sent.at, now);
    sent.open = false;
    if (!sent.as_datagram || !by_datagram || sent.confirmed) return;
    sent.confirmed = true;
    // What was sent before the line fell silent says nothing of it now.
    if (now - sent.at < 2 * PathProbe::kOpenFor) m_probe.addEvidence(now);
  }

  std::array<Sent, kKept> m_sent{};
  std::array<AckWindow, 2> m_acked{};  ///< the newest windows taken in, on the stream and by datagram
  PathProbe m_probe;
  LinkStats m_stats;
  std::size_t m_rung = 0;
  Time m_bad_since{};
  Time m_good_since{};
  bool m_bad = false;
};

}  // namespace naiad
