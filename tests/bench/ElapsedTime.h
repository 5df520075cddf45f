// CPU time of this thread. Other programs increase it only by their effect on the caches.
#pragma once

#include <ctime>

namespace bench {

/// Returns the CPU time that this thread has used so far, in nanoseconds.
inline double cpuNanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

}  // namespace bench
