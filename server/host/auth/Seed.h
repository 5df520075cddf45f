// A seed that cannot be predicted.
#pragma once

#include <cstdint>
#include <random>

namespace naiad {

/// 1 to 9e15, as --seed takes them.
inline std::uint64_t newSeed() {
  std::random_device device;
  return 1 + ((static_cast<std::uint64_t>(device()) << 21) ^ device()) % 9'000'000'000'000'000;
}

}  // namespace naiad
