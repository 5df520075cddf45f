// Measures time between calls, in microseconds (book, Listing 4.21). It is the game's time, which is the same
// in every run with the same inputs: a tick has its nominal length, however long it took. Within a tick each
// reading is a microsecond later than the one before, so that a loop that waits comes to an end.
#pragma once

namespace df {

class Clock {
 public:
  /// From now on.
  Clock();
  /// Time since the last call, or since the clock was made; restarts the clock.
  long int delta();
  /// The same, and goes on.
  long int split() const;

 private:
  long int m_previous_time;
};

}  // namespace df
