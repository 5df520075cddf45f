// The world's random numbers: a seed gives the same sequence on every machine.
//
// xoshiro256** (Blackman and Vigna, 2018), seeded through splitmix64.
#pragma once

#include <array>
#include <cstdint>

namespace df {

class Random {
 public:
  /// Starts the random sequence of this seed.
  explicit Random(std::uint64_t seed = 1);

  /// Returns 64 random bits.
  std::uint64_t next();
  /// Returns a random number 0 to n-1, each equally likely; 0 if n < 1.
  int below(int n);

 private:
  std::array<std::uint64_t, 4> m_state;
};

}  // namespace df
