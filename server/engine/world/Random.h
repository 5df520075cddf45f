// The world's random numbers: the same sequence for the same seed on every machine.
//
// xoshiro256** (Blackman and Vigna, 2018), seeded through splitmix64.
#pragma once

#include <array>
#include <cstdint>

namespace df {

class Random {
 public:
  explicit Random(std::uint64_t seed = 1);

  /// 64 random bits.
  std::uint64_t next();
  /// 0 to n-1, each equally likely; 0 if n < 1.
  int below(int n);
  /// Where in its sequence it is: for comparisons.
  std::uint64_t fingerprint() const { return m_state[0] ^ m_state[1] << 1 ^ m_state[2] << 2 ^ m_state[3] << 3; }

 private:
  std::array<std::uint64_t, 4> m_state;
};

}  // namespace df
