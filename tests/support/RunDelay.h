// Measures how long a process waited for a processor, so that time limits hold on a busy machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace naiad::test {

/// Returns the total time that this process's current threads were ready to run but did not (the second
/// number of /proc/PID/task/TID/schedstat); zero if the kernel does not report it.
inline std::chrono::nanoseconds runDelay() {
  std::int64_t sum = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::int64_t ran = 0;
    std::int64_t waited = 0;
    if (std::ifstream(thread.path() / "schedstat") >> ran >> waited) sum += waited;
  }
  return std::chrono::nanoseconds(sum);
}

}  // namespace naiad::test
