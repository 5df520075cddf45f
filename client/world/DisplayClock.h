// Chooses the tick to draw now.
//
// Snapshots describe the world at a tick; between them the replica extrapolates. This clock estimates when
// each tick should arrive. Early arrivals, and those more than a second late, correct the estimate at once;
// others by a sixteenth of the difference, so that jitter does not shake the picture. The clock runs ahead of
// the estimate by the snapshots' delay (setDelay()), at most 250 ms beyond the newest snapshot. After 500 ms
// without a snapshot, a banner says that the connection is silent.
//
// Ticks are compared as serial numbers. The caller passes the time.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace naiad {

class DisplayClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// Limit on how far the picture runs ahead of the newest snapshot.
  static constexpr std::chrono::milliseconds kMaxAhead{250};
  /// Limit on the lead that makes up for the snapshots' delay.
  static constexpr std::chrono::milliseconds kMaxLead{50};
  /// Time without a snapshot after which the connection counts as silent.
  static constexpr std::chrono::milliseconds kSilence{500};

  explicit DisplayClock(Duration tick_length) : m_length(tick_length) {}

  /// Sets the age of a snapshot on arrival: half the shortest round trip. The picture makes up for it, up to
  /// kMaxLead. With a longer lead, objects that change course would make more cells wrong than it corrects.
  void setDelay(Duration delay) { m_lead = std::clamp<Duration>(delay, Duration::zero(), kMaxLead); }
  void onSnapshot(std::uint32_t tick, Time now);
  /// Returns the tick to draw: not below the last, unless that is over kMaxAhead beyond the newest snapshot.
  std::uint32_t displayTick(Time now);
  /// Returns the ticks since the newest should have arrived, at most kMaxAhead; 0 before the first snapshot.
  double ticksSinceNewest(Time now) const;
  /// Returns the newest tick of any snapshot; 0 before the first.
  std::uint32_t newestTick() const { return m_newest; }
  /// True if no snapshot has come for kSilence; false before the first.
  bool isSilent(Time now) const { return m_started && now - m_last_arrival >= kSilence; }
  /// Returns the time since the last snapshot; zero before the first.
  Duration silence(Time now) const { return m_started ? now - m_last_arrival : Duration::zero(); }
  /// Returns the earliest time at which displayTick() may return another tick, for a timer.
  Time nextTick(Time now) const;

 private:
  Duration due(std::uint32_t tick) const;

  Duration m_length;
  Duration m_lead{0};
  bool m_started = false;
  std::uint32_t m_newest = 0;
  std::uint32_t m_shown = 0;
  std::uint32_t m_anchor = 0;  ///< a tick; it should have arrived at m_anchor_time
  Time m_anchor_time{};
  Time m_last_arrival{};
};

}  // namespace naiad
