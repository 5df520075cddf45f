// hard_pile: a hostile server shows dfclient 48,000 moving HARD Objects in one place. Measures the time until
// dfclient handles SIGTERM and Ctrl-C.
#pragma once

#include <chrono>

namespace bench::attack {

struct PileResult {
  double sigterm_ms = 0;  ///< time from the signal until dfclient ended; kPilePatience if it did not
  double ctrl_c_ms = 0;
  long long objects = 0;  ///< objects sent to dfclient
  bool ended = false;     ///< dfclient ended before the signal
};

inline constexpr std::chrono::milliseconds kPilePatience{10000};

/// Tests SIGTERM and Ctrl-C, each after half of this time, at least 2 s. Throws std::runtime_error on
/// failure.
PileResult runHardPile(std::chrono::seconds duration);

}  // namespace bench::attack
