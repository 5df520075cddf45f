// Which tick belongs on the screen now.
//
// Snapshots describe the world at a tick; between them the replica extrapolates. This clock estimates when
// each tick should arrive (the earliest arrivals count, later ones pull the estimate back gently, so that
// jitter does not shake the picture) and runs ahead of it by the snapshots' delay, at most 250 ms beyond the
// newest snapshot. After 500 ms without one the picture stands still and a banner says so.
//
// Ticks are compared as serial numbers. Time is a parameter.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace naiad {

class DisplayClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// How far the picture may run ahead of the newest snapshot.
  static constexpr std::chrono::milliseconds kMaxAhead{250};
  /// How far it runs ahead in any case, to make up for the delay of the snapshots.
  static constexpr std::chrono::milliseconds kMaxLead{50};
  /// Silence that counts as a broken line.
  static constexpr std::chrono::milliseconds kSilence{500};

  explicit DisplayClock(Duration tick_length) : m_length(tick_length) {}

  /// The age of a snapshot on arrival: half the shortest round trip. The picture makes up for it, up to
  /// kMaxLead: beyond that, objects that change course make more cells wrong than the lead makes right.
  void setDelay(Duration delay) { m_lead = std::clamp<Duration>(delay, Duration::zero(), kMaxLead); }
  /// A snapshot of `tick` arrived.
  void noteSnapshot(std::uint32_t tick, Time now);
  /// The tick to draw. Never lower than the last one returned, unless that lies beyond the allowed lead.
  std::uint32_t displayTick(Time now);
  /// Time since the newest tick should have arrived, in ticks; at most what the picture may run ahead.
  double ticksSinceNewest(Time now) const;
  /// The newest tick of any snapshot; 0 before the first.
  std::uint32_t newestTick() const { return m_newest; }
  /// No snapshot for kSilence (never before the first).
  bool isSilent(Time now) const { return m_started && now - m_last_arrival >= kSilence; }
  /// How long ago the last snapshot came; zero before the first.
  Duration silence(Time now) const { return m_started ? now - m_last_arrival : Duration::zero(); }
  /// When displayTick() will next return another tick, for a timer.
  Time nextTick(Time now) const;

 private:
  Duration due(std::uint32_t tick) const;

  Duration m_length;
  Duration m_lead{0};
  bool m_started = false;
  std::uint32_t m_newest = 0;
  std::uint32_t m_shown = 0;
  std::uint32_t m_anchor = 0;  ///< a tick and when it should have arrived
  Time m_anchor_time{};
  Time m_last_arrival{};
};

}  // namespace naiad
