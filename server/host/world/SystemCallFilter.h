// The system calls that a world's process is refused, as a seccomp program in classic BPF.
//
// It is a list of what is refused, and not of what is allowed: what a compiler's or a library's runtime calls
// differs from one machine to the next. Calls that are newer than the list are refused as well.
#pragma once

#include <linux/filter.h>
#include <sys/types.h>

#include <vector>

namespace naiad {

/// What decides where the filter has to be narrower.
struct FilterScene {
  pid_t self = 0;                ///< the process that installs it
  bool signals_scoped = false;   ///< Landlock keeps its signals from other processes
  bool truncation_held = false;  ///< Landlock decides about truncate(), too
  bool traces_itself = false;    ///< ptrace() stays, as a sanitizer's runtime needs it
};

/// Empty where this was built for a processor without a list. Refused calls fail with EPERM; those that have
/// an older substitute, and those that are not known yet, with ENOSYS.
std::vector<sock_filter> makeSystemCallFilter(const FilterScene& scene);

/// Install it for this thread and all that it starts, for good. PR_SET_NO_NEW_PRIVS has been called. Return
/// errno, or 0.
int installSystemCallFilter(std::vector<sock_filter> filter);

}  // namespace naiad
