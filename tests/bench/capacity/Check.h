// Which pictures both ends of the suite `capacity` look at, and how they tell whether they are the same.
#pragma once

#include <cstdint>

#include "shared/values/Canvas.h"

namespace bench::capacity {

/// A player's screen is compared in one of so many ticks: to draw it costs the server what it is measured by.
inline constexpr std::uint32_t kCheckEvery = 32;
inline bool isChecked(std::uint32_t player, std::uint32_t tick) {
  return (player + tick) % kCheckEvery == 0;
}
/// Players with this in front of their names are checked.
inline constexpr const char* kCheckedName = "check";

/// A sum over all cells, characters and colours (FNV-1a).
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
