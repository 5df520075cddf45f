// Measures time between calls, in microseconds (book, Listing 4.21). It is game time, the same in all runs
// with the same inputs: a tick has its nominal length, however long it took. Within a tick each reading is a
// microsecond later than the one before, so that a loop that waits for a time ends.
#pragma once

namespace df {

class Clock {
 public:
  /// Makes the clock and starts it.
  Clock();
  /// Returns the time since the last call, or since the clock was made, and restarts the clock.
  long int delta();
  /// Like delta(), without restarting the clock.
  long int split() const;

 private:
  long int m_previous_time;
};

}  // namespace df
