// The processes that descend from this one, and their end.
#pragma once

#include <sys/types.h>

#include <set>
#include <vector>

namespace naiad {

struct Descendant {
  pid_t process = 0;
  pid_t branch = 0;  ///< the child of this process that it is, or descends from
};

/// All that are there now, as /proc says. Zombies, too.
std::vector<Descendant> findDescendants();

/// Does this process descend from the present one, as /proc says now? False for the present one itself.
bool isDescendant(pid_t process);

/// Its children, zombies among them, as the kernel lists them for it alone: at once, and however they hide in
/// /proc. For a process without threads. None on a kernel that keeps no such list.
std::vector<pid_t> findChildren();

/// SIGKILL for this child, which has not been waited for, and for its process group, if it leads one.
void endChild(pid_t child);

/// SIGKILL for all descendants, and for the process group of `leader`, until none is left. A descendant
/// whose parent has ended is a child then, so one that goes from process to process is followed. For a
/// process without threads that is a child subreaper (PR_SET_CHILD_SUBREAPER): to it come those whose parents
/// have ended, whatever group or session they have gone to. Return the status of `leader`, a child that has
/// not been waited for; that of a SIGKILL if it cannot be had. 0: all of them, without a leader.
int endDescendants(pid_t leader);

/// The same for all but these children and what descends from them. False: too many came for that; then all
/// are to be ended.
bool endOthers(const std::set<pid_t>& kept);

}  // namespace naiad
