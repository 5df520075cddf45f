// Mixes numbers into 64 bits, one after the other, for checksums. Not secure against attacks.
#pragma once

#include <cstdint>

#include "shared/values/Fixed.h"

namespace naiad {

/// Applies the finaliser of SplitMix64 between the numbers.
class Mixer {
 public:
  void add(std::uint64_t value) {
    m_state += value + 0x9E3779B97F4A7C15;
    m_state = (m_state ^ (m_state >> 30)) * 0xBF58476D1CE4E5B9;
    m_state = (m_state ^ (m_state >> 27)) * 0x94D049BB133111EB;
    m_state ^= m_state >> 31;
  }
  void add(df::FixedVector v) {
    add(static_cast<std::uint64_t>(v.x));
    add(static_cast<std::uint64_t>(v.y));
  }
  std::uint64_t value() const { return m_state; }

 private:
  std::uint64_t m_state = 0;
};

}  // namespace naiad
