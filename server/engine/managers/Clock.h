// Measures time between calls, in microseconds (book, Listing 4.21). It is the game's time, which is the same
// for everybody who plays the same inputs: a tick is a tick long, however long it took. Within a tick each
// reading is a microsecond later than the one before, so that a loop that waits comes to an end.
#pragma once

namespace df {

class Clock {
 public:
  /// From now on.
  Clock();
  /// Time since the last call, or since the clock was made; begins anew.
  long int delta();
  /// The same, and goes on.
  long int split() const;

 private:
  long int m_previous_time;
};

}  // namespace df
