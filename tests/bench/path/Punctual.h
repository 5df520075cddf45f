// For processes that other processes are measured by.
#pragma once

#include <sched.h>
#include <sys/prctl.h>

namespace bench::path {

/// Let this process, but none of its children to come, be woken exactly when it wants, and before others. A
/// wish: not everybody may have a priority.
inline void becomePunctual() {
  prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param priority{};
  priority.sched_priority = 1;
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority);
}

}  // namespace bench::path
