// hard_pile: a hostile server shows dfclient 48,000 moving HARD Objects in one place. Measures the time until
// dfclient handles SIGTERM and Ctrl-C.
#pragma once

#include <chrono>

namespace bench::attack {

struct PileResult {
  double sigterm_ms = 0;  ///< time until dfclient ended; kPilePatience if it did not
  double ctrl_c_ms = 0;
  long long objects = 0;  ///< objects sent to it
  bool ended = false;     ///< it ended by itself
};

inline constexpr std::chrono::milliseconds kPilePatience{10000};

/// Runs both cases, each half of this time before the signal. Throws std::runtime_error on failure.
PileResult runHardPile(std::chrono::seconds duration);

}  // namespace bench::attack
