// Makes a random seed that cannot be predicted.
#pragma once

#include <cstdint>
#include <random>

namespace naiad {

/// Returns 1 … 9e15, the range of --seed.
inline std::uint64_t newSeed() {
  std::random_device device;
  return 1 + ((static_cast<std::uint64_t>(device()) << 21) ^ device()) % 9'000'000'000'000'000;
}

}  // namespace naiad
