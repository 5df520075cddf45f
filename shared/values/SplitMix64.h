// A small random number generator for tests and their lossy links, and to seed the world's generator
// (server/engine/world/Random.h). A seed gives equal numbers on every machine.
//
// Steele, Lea, Flood: "Fast splittable pseudorandom number generators", OOPSLA 2014. Not for secrets.
#pragma once

#include <cstdint>

namespace naiad {

class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 uniform bits.
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Returns a uniform number in 0 … n − 1, without bias; 0 for n = 0.
  std::uint64_t below(std::uint64_t n) {
    if (n == 0) return 0;
    const std::uint64_t rejected = (0 - n) % n;  // 2⁶⁴ mod n, rejected to avoid a bias
    std::uint64_t value = next();
    while (value < rejected) value = next();
    return value % n;
  }

  /// Returns a uniform number in [0, 1), a multiple of 2⁻⁵³.
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

}  // namespace naiad
