#include "engine/world/Random.h"

#include <bit>

#include "shared/values/SplitMix64.h"

namespace df {

Random::Random(std::uint64_t seed) {
  naiad::SplitMix64 seeder(seed);
  for (std::uint64_t& word : m_state) word = seeder.next();
}

std::uint64_t Random::next() {
  const std::uint64_t result = std::rotl(m_state[1] * 5, 7) * 9;
  const std::uint64_t shifted = m_state[1] << 17;
  m_state[2] ^= m_state[0];
  m_state[3] ^= m_state[1];
  m_state[1] ^= m_state[2];
  m_state[0] ^= m_state[3];
  m_state[2] ^= shifted;
  m_state[3] = std::rotl(m_state[3], 45);
  return result;
}

// Remainders by n would favour small numbers, so random numbers above the last multiple of n are drawn again.
int Random::below(int n) {
  if (n < 1) return 0;
  const auto divisor = static_cast<std::uint64_t>(n);
  const std::uint64_t excess = (UINT64_MAX % divisor + 1) % divisor;
  std::uint64_t bits = next();
  while (bits > UINT64_MAX - excess) bits = next();
  return static_cast<int>(bits % divisor);
}

}  // namespace df
