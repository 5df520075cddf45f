// Masks for precise collisions.
#pragma once

#include <string>

#include "shared/values/SplitMix64.h"
#include "tests/server/engine/oracle/OracleMask.h"

namespace bench {

/// Returns the characters of 3×2 to 12×4 cells, each of which is set with a probability of 55 %.
inline oracle::Mask randomMask(naiad::SplitMix64& random) {
  const std::uint64_t width = 3 + random.below(10);
  const std::uint64_t height = 2 + random.below(3);
  oracle::Mask mask(height, std::string(width, ' '));
  for (std::string& row : mask) {
    for (char& character : row) {
      if (random.unit() < 0.55) character = '#';
    }
  }
  return mask;
}

}  // namespace bench
