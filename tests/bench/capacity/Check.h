// Which pictures the suite `capacity` compares at both ends, and their checksums.
#pragma once

#include <cstdint>

#include "shared/values/Canvas.h"

namespace bench::capacity {

/// Each checked player's screen is compared in one of this number of ticks, because drawing it costs server
/// time.
inline constexpr std::uint32_t kCheckEvery = 32;
inline bool isChecked(std::uint32_t player, std::uint32_t tick) {
  return (player + tick) % kCheckEvery == 0;
}
/// The names of checked players begin with this.
inline constexpr const char* kCheckedName = "check";

/// Returns a checksum over all cells, characters and colours (FNV-1a).
inline std::uint64_t pictureSum(const df::Canvas& canvas) {
  std::uint64_t sum = 0xcbf29ce484222325;
  const auto mix = [&sum](std::uint64_t value) { sum = (sum ^ value) * 0x100000001b3; };
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const df::Cell cell = canvas.at(x, y);
      mix(cell.ch);
      mix(cell.ch == U' ' ? 0 : static_cast<std::uint64_t>(cell.color) + 1);
    }
  }
  return sum;
}

}  // namespace bench::capacity
