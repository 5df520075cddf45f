// Chooses whether a session's snapshots are sent as datagrams or on the stream, and how often, from the
// connection's round-trip time and losses.
//
// A session starts on the stream. It probes with a snapshot sent as a datagram: once a second, but more often
// at first, after an outage, and while it has no stream. Once a datagram acknowledges such a datagram,
// snapshots are datagrams. They use the stream again after a second without such an acknowledgement. (An
// acknowledgement on the stream would prove one direction only, and the player's keys would get lost in the
// other.) Callers pass the time.
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

  explicit TransportSelector(Time now) : m_probe(PathProbe::kOpenTime, now) {}

  /// Records that snapshot `number` was sent, as a datagram or on the stream.
  void markSent(std::uint32_t number, bool as_datagram, Time now) {
    m_sent[number % kKept] = {number, as_datagram, true, false, now};
    if (as_datagram && !isOpen(now)) m_probe.probeSent(now);
  }
  /// Processes an acknowledgement that came by datagram or on the stream.
  void acknowledge(const AckWindow& acks, bool by_datagram, Time now) {
    // Only bits that are not in the previous window of this transport are new.
    AckWindow& before = m_acked[by_datagram ? 1 : 0];
    const std::uint32_t ahead = acks.newest - before.newest;
    const bool follows = before.newest != 0 && !isNewer(before.newest, acks.newest) && ahead <= 64;
    std::uint64_t fresh = acks.mask;
    if (follows && ahead > 0)
      fresh &= ~((ahead < 64 ? before.mask << ahead : 0) | std::uint64_t{1} << (ahead - 1));
    if (follows && ahead == 0) fresh &= ~before.mask;
    if (before.newest == 0 || !isNewer(before.newest, acks.newest)) before = acks;
    recordArrival(acks.newest, true, by_datagram, now);
    for (; fresh != 0; fresh &= fresh - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(fresh));
      recordArrival(acks.newest - 1 - bit, false, by_datagram, now);
    }
  }
  /// Call when the client uses another address or stream: probes again soon.
  void renew(Time now) { m_probe.renew(now); }

  /// True if datagrams pass.
  bool isOpen(Time now) const { return m_probe.isOpen(now); }
  /// True if a probe is due. `only`: true if there is no stream.
  bool wantsProbe(Time now, bool only = false) const { return m_probe.isDue(now, only); }

  /// Smoothed time from sending to acknowledgement; 0 before the first sample.
  Millis roundTrip() const { return m_stats.smoothed(); }
  /// The shortest round trip of about the last ten seconds.
  Millis shortestRoundTrip() const { return m_stats.shortest(); }

  /// Returns how many ticks apart snapshots are sent: 1, 2, 3 or 6. It grows while the connection is
  /// overloaded (its queues grow, or it loses more than 15 %) and shrinks again after five good seconds.
  std::uint32_t interval(double loss, Time now) {
    const bool bad = roundTrip() - shortestRoundTrip() > kFullQueue || loss > kHighLoss;
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
  static constexpr double kHighLoss = 0.15;
  static constexpr std::chrono::seconds kBadFor{1};
  static constexpr std::chrono::seconds kGoodFor{5};

  struct Sent {
    std::uint32_t number = 0;
    bool as_datagram = false;
    bool open = false;       ///< not acknowledged yet
    bool confirmed = false;  ///< a datagram that a datagram has acknowledged
    Time at{};
  };
  static constexpr std::size_t kKept = 128;
  static constexpr std::array<std::uint32_t, 4> kIntervals = {1, 2, 3, 6};

  void recordArrival(std::uint32_t number, bool newest, bool by_datagram, Time now) {
    Sent& sent = m_sent[number % kKept];
    if (sent.number != number || number == 0) return;
    if (sent.open && newest) m_stats.addSample(now - sent.at, now);
    sent.open = false;
    if (!sent.as_datagram || !by_datagram || sent.confirmed) return;
    sent.confirmed = true;
    // An older datagram may predate an outage, so it proves nothing about the present path.
    if (now - sent.at < 2 * PathProbe::kOpenTime) m_probe.addEvidence(now);
  }

  std::array<Sent, kKept> m_sent{};
  std::array<AckWindow, 2> m_acked{};  ///< newest windows received: on the stream, by datagram
  PathProbe m_probe;
  LinkStats m_stats;
  std::size_t m_rung = 0;
  Time m_bad_since{};
  Time m_good_since{};
  bool m_bad = false;
};

}  // namespace naiad
