// The common clock of all processes of a measurement, and their scheduling.
#pragma once

#include <sched.h>
#include <sys/prctl.h>

#include <chrono>
#include <cstdint>
#include <ctime>

namespace bench::path {

using Nanoseconds = std::chrono::nanoseconds;

constexpr Nanoseconds fromMilliseconds(double value) {
  return Nanoseconds(static_cast<std::int64_t>(value * 1e6));
}

/// Returns CLOCK_MONOTONIC, which is equal in all namespaces.
inline Nanoseconds monotonicNow() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + Nanoseconds(now.tv_nsec);
}

inline double milliseconds(Nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

inline timespec toTimespec(Nanoseconds time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
  return {static_cast<time_t>(seconds.count()), static_cast<long>((time - seconds).count())};
}

/// Requests that this process, but not its later children, is woken exactly on time and before other
/// processes. Has no effect without the permission to set a priority.
inline void becomePunctual() {
  prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param priority{};
  priority.sched_priority = 1;
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority);
}

}  // namespace bench::path
