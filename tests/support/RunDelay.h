// How long a process has waited for a processor, so that limits on time hold on a busy machine, too.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace naiad::test {

/// Returns how long this process's threads that still run have been ready to run and did not (the second
/// number of /proc/PID/task/TID/schedstat), added up; zero if the kernel does not tell.
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
