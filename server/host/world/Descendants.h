// Finds and ends the processes that descend from this one.
#pragma once

#include <sys/types.h>

#include <set>
#include <vector>

namespace naiad {

struct Descendant {
  pid_t process = 0;
  pid_t branch = 0;  ///< the child of this process that `process` is, or descends from
};

/// Returns all current descendants, as listed in /proc, including zombies.
std::vector<Descendant> findDescendants();

/// True if `process` descends from this process now, according to /proc. False for this process itself.
bool isDescendant(pid_t process);

/// Returns the children of this process, including zombies. They come from the kernel's list for this
/// process, which is read in one step, and has even children that hide in /proc. For a process without
/// threads. Empty if the kernel has no such list.
std::vector<pid_t> findChildren();

/// Sends SIGKILL to this child, which has not been waited for, and to its process group if it leads one.
void killChild(pid_t child);

/// Sends SIGKILL to all descendants, and to the process group of `leader`, until none is left. For a process
/// without threads that is a child subreaper (PR_SET_CHILD_SUBREAPER): a descendant whose parent has ended
/// becomes its child, whatever its group or session, so no descendant can escape by forking. `leader`: a
/// child that has not been waited for; 0: none. Returns its status, or SIGKILL if that is not available.
int killDescendants(pid_t leader);

/// Like killDescendants(), but spares these children and their descendants. Returns false if it takes too
/// long; then the caller must end all descendants.
bool killOthers(const std::set<pid_t>& kept);

}  // namespace naiad
