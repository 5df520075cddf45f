// The processes that descend from this one, and their end.
#pragma once

#include <sys/types.h>

#include <vector>

namespace naiad {

struct Descendant {
  pid_t process = 0;
  pid_t branch = 0;  ///< the child of this process that it is, or descends from
};

/// All that are there now, as /proc says. Zombies, too.
std::vector<Descendant> findDescendants();

/// SIGKILL for all descendants, and for the process group of `leader`, until none is left. For a process
/// without threads that is a child subreaper (PR_SET_CHILD_SUBREAPER): to it come those whose parents have
/// ended, whatever group or session they have gone to. Return the status of `leader`, a child that has not
/// been waited for; that of a SIGKILL if it cannot be had.
int endDescendants(pid_t leader);

}  // namespace naiad
