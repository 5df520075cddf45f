// CPU time of this thread. Other programs do not add to it, except through their effect on the caches.
#pragma once

#include <ctime>

namespace bench {

/// Returns nanoseconds since a fixed moment.
inline double cpuNanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

}  // namespace bench
