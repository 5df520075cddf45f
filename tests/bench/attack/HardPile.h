// hard_pile: a hostile server shows dfclient 48,000 moving HARD Objects in one place. Does it still hear
// SIGTERM and Ctrl-C?
#pragma once

#include <chrono>

namespace bench::attack {

struct PileResult {
  double sigterm_ms = 0;  ///< until dfclient had ended; kPilePatience if it did not
  double ctrl_c_ms = 0;
  long long objects = 0;  ///< that it was sent
  bool ended = false;     ///< it gave up by itself
};

inline constexpr std::chrono::milliseconds kPilePatience{10000};

/// Twice, each half of this time before the signal. Throws std::runtime_error if nothing could be measured.
PileResult runHardPile(std::chrono::seconds duration);

}  // namespace bench::attack
