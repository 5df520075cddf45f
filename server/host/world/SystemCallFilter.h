// The system calls refused to a world's process, as a seccomp program in classic BPF.
//
// It lists refused calls and not allowed ones, because the calls of compilers' and libraries' runtimes differ
// between machines. Calls newer than the list are refused as well.
#pragma once

#include <linux/filter.h>
#include <sys/types.h>

#include <vector>

namespace naiad {

/// Conditions that make the filter stricter or laxer.
struct FilterScene {
  pid_t self = 0;                ///< the process that installs the filter
  bool signals_scoped = false;   ///< Landlock blocks signals to other processes
  bool truncation_held = false;  ///< Landlock restricts truncate()
  bool traces_itself = false;    ///< ptrace() is allowed, because a sanitizer's runtime needs it
};

/// Returns the filter; empty on a processor without a list. Refused calls fail with EPERM. Calls that have an
/// older substitute, and those that are not known yet, fail with ENOSYS.
std::vector<sock_filter> makeSystemCallFilter(const FilterScene& scene);

/// Installs the filter for this thread and all that it starts, permanently. Call it in a world's process,
/// before its program. PR_SET_NO_NEW_PRIVS must be set. Returns errno, or 0; ENOSYS if `filter` is empty.
int installSystemCallFilter(std::vector<sock_filter> filter);

}  // namespace naiad
