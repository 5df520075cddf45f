// Random numbers that are equal on every machine.
#pragma once

#include <cstdint>

#include "shared/values/SplitMix64.h"

namespace oracle {

/// Spreads the bits of `x`.
inline std::uint64_t mix(std::uint64_t x) {
  return naiad::SplitMix64(x).next();
}

class Rng : private naiad::SplitMix64 {
 public:
  using naiad::SplitMix64::next;
  using naiad::SplitMix64::SplitMix64;

  /// Returns 0 to n - 1; n > 0. The bias is below 2^-32 for the small n used here.
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  /// Returns low to high, both included.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// True in `percent` of 100 cases.
  bool chance(int percent) { return below(100) < percent; }
};

}  // namespace oracle
