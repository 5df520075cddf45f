// Which way a session's snapshots take, and what is known of that way: do datagrams pass, how long is the
// round trip, how much is lost, and so how often to send.
//
// A session starts on the stream. Once a second, and at first more often, it sends a snapshot as a datagram;
// when one of those is acknowledged by a datagram, snapshots go as datagrams from then on, until none of them
// has been acknowledged so for a second. (An acknowledgement on the stream would say that datagrams pass in
// one direction only; then the player's keys would get lost.) Pure: time is passed in.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

#include "shared/replica/Acks.h"

namespace naiad {

class TransportSelector {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Millis = std::chrono::duration<double, std::milli>;

  static constexpr std::chrono::milliseconds kIdleTimer{1000};   ///< without an acknowledgement: not passing
  static constexpr std::chrono::milliseconds kProbeEvery{1000};  ///< while they do not pass
  static constexpr std::chrono::milliseconds kFirstProbes{
      100};  ///< in the first kSilence of a session or path
  /// While they passed a moment ago, or there is no other way: on a line that loses most, one probe a second
  /// hardly ever gets through and its acknowledgement back.
  static constexpr std::chrono::milliseconds kEagerProbes{250};
  static constexpr std::chrono::seconds kEagerFor{10};

  explicit TransportSelector(Time now) : m_began(now) {}

  /// Snapshot `number` was sent, as a datagram or on the stream.
  void sent(std::uint32_t number, bool as_datagram, Time now);
  /// The client acknowledged, by a datagram or on the stream.
  void acknowledged(const AckWindow& acks, bool by_datagram, Time now);
  /// Another address or stream: find out again, soon.
  void renewed(Time now) { m_began = now; }

  /// Do datagrams pass?
  bool isOpen(Time now) const { return m_open && now - m_last_ack < kIdleTimer; }
  /// Is it time to try whether they do? `only`: there is no other way.
  bool wantsProbe(Time now, bool only = false) const {
    return !isOpen(now) && now - m_last_probe >= probeInterval(now, only);
  }

  /// From sending to acknowledgement, smoothed; 0 before the first.
  Millis roundTrip() const { return m_round_trip; }
  /// The shortest one of about the last ten seconds.
  Millis shortestRoundTrip() const { return std::min(m_shortest, m_shortest_before); }

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

  std::chrono::milliseconds probeInterval(Time now, bool only) const {
    if (now - m_began < kIdleTimer) return kFirstProbes;
    return only || (m_open && now - m_last_ack < kEagerFor) ? kEagerProbes : kProbeEvery;
  }
  void measure(Millis sample, Time now);
  void noteArrival(std::uint32_t number, bool newest, bool by_datagram, Time now);

  std::array<Sent, kKept> m_sent{};
  std::array<AckWindow, 2> m_acked{};  ///< the newest windows taken in, on the stream and by datagram
  Time m_began;
  Time m_last_probe{};
  Time m_last_ack{};
  bool m_open = false;
  Millis m_round_trip{0};
  Millis m_shortest{1e9};
  Millis m_shortest_before{1e9};
  Time m_shortest_since{};
  std::size_t m_rung = 0;
  Time m_bad_since{};
  Time m_good_since{};
  bool m_bad = false;
};

}  // namespace naiad
