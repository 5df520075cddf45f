// CPU time of this thread: what others do on the machine meanwhile is not in it (what they do to its caches
// is).
#pragma once

#include <ctime>

namespace bench {

/// In nanoseconds, since some moment.
inline double cpuNanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

}  // namespace bench
