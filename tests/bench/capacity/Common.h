// Common parts of the programs: processor cores, and the pictures that are compared at both ends.
#pragma once

#include <sched.h>

#include <cstdint>
#include <ctime>

#include "shared/values/Canvas.h"

namespace bench::capacity {

/// Restricts this process and its later threads to one core. False if this core is not available.
inline bool pinTo(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

/// Returns the processor time that this process has used, in microseconds.
inline double cpuMicros() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) / 1e3;
}

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
