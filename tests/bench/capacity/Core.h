// Processes and processor cores.
#pragma once

#include <sched.h>

#include <cstdint>
#include <ctime>

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

}  // namespace bench::capacity
