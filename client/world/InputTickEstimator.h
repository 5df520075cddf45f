// In which tick will the server take in a key that is pressed now?
//
// It goes out now, and the server's tick is by then what the newest snapshot said, and what has passed since,
// and a round trip: half of it for that snapshot's way here, half for the key's way there. A margin on top
// makes up for jitter: it grows when an input came too late for the tick it asked for, and shrinks with each
// that did not, so that one in forty may be late (more than that is loss, which no margin helps).
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

  static constexpr double kMinMargin = 0.25;  ///< ticks
  static constexpr double kMaxMargin = 6;
  static constexpr double kGrow = 0.15;
  static constexpr double kShrink = 0.004;

  /// The shortest of the last few counts: longer ones waited somewhere.
  void noteRoundTrip(Millis sample);
  /// The server took an input in at the end of `taken`; it had asked for `asked`.
  void noteTaken(std::uint32_t asked, std::uint32_t taken);
  /// The tick, for a key pressed at `now`.
  std::uint32_t tickFor(const DisplayClock& clock, DisplayClock::Duration tick_length, Time now) const;

  Millis shortestRoundTrip() const;
  double margin() const { return m_margin; }

 private:
  std::array<Millis, 8> m_round_trips{};
  std::size_t m_count = 0;
  double m_margin = kMinMargin;
};

}  // namespace naiad
