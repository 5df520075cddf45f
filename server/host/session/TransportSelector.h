// Whether a session's snapshots go by datagram or on the stream, and how often: by what is known of the link,
// its round trip and its losses.
//
// A session starts on the stream. Once a second, and at first more often, it sends a snapshot as a datagram;
// when one of those is acknowledged by a datagram, snapshots go as datagrams from then on, until none of them
// has been acknowledged so for a second. (An acknowledgement on the stream would say that datagrams pass in
// one direction only; then the player's keys would get lost.) Pure: time is passed in.
#pragma once

#include <array>
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
  void noteSent(std::uint32_t number, bool as_datagram, Time now);
  /// The client acknowledged, by a datagram or on the stream.
  void acknowledge(const AckWindow& acks, bool by_datagram, Time now);
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
  std::uint32_t interval(double loss, Time now);

 private:
  struct Sent {
    std::uint32_t number = 0;
    bool as_datagram = false;
    bool open = false;       ///< not acknowledged yet
    bool confirmed = false;  ///< a datagram that a datagram acknowledged
    Time at{};
  };
  static constexpr std::size_t kKept = 128;
  static constexpr std::array<std::uint32_t, 4> kIntervals = {1, 2, 3, 6};

  void noteArrival(std::uint32_t number, bool newest, bool by_datagram, Time now);

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
