// Estimates the tick in which the server will apply a key that is pressed now.
//
// That is the tick of the newest snapshot, plus the time since its arrival, plus a round trip: half for the
// snapshot's delay, half for the key's. A margin on top makes up for jitter. It grows when an input was too
// late for its requested tick, and shrinks with each that was not, so that about one in forty is late. Packet
// loss makes more inputs late, which no margin prevents.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "client/world/DisplayClock.h"

namespace naiad {

class InputTickEstimator {
 public:
  using Time = DisplayClock::Time;
  using Millis = std::chrono::duration<double, std::milli>;

  static constexpr double kMinMargin = 0.25;  ///< limits of the margin, in ticks
  static constexpr double kMaxMargin = 6;
  static constexpr double kGrow = 0.15;
  static constexpr double kShrink = 0.004;

  /// Adds a round trip. The shortest of the last eight is used, because longer ones include queueing.
  void addRttSample(Millis sample);
  /// Call when the server has applied an input in tick `taken` that requested tick `asked`.
  void onInputApplied(std::uint32_t asked, std::uint32_t taken);
  /// Returns the estimated tick for a key pressed at `now`, at most 61 ticks after the newest snapshot's.
  std::uint32_t tickFor(const DisplayClock& clock, DisplayClock::Duration tick_length, Time now) const;

  Millis shortestRoundTrip() const;
  double margin() const { return m_margin; }

 private:
  std::array<Millis, 8> m_round_trips{};
  std::size_t m_count = 0;
  double m_margin = kMinMargin;
};

}  // namespace naiad
