// Scheduling for processes that measure others.
#pragma once

#include <sched.h>
#include <sys/prctl.h>

namespace bench::path {

/// Requests that this process, but not its later children, is woken exactly on time and before other
/// processes. Has no effect without the permission to set a priority.
inline void becomePunctual() {
  prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param priority{};
  priority.sched_priority = 1;
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority);
}

}  // namespace bench::path
