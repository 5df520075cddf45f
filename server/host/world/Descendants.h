// Finds and ends the processes that descend from this one.
#pragma once

#include <sys/types.h>

#include <set>
#include <string>
#include <vector>

namespace naiad {

struct Descendant {
  pid_t process = 0;
  pid_t branch = 0;  ///< the child of this process that `process` is, or descends from
};

/// Returns all current descendants, as listed in /proc, including zombies.
std::vector<Descendant> findDescendants();

/// Returns the fields of /proc/PID/stat behind the program's name, which may contain anything: "S 1 …", its
/// state and parent. Empty if there is no such process.
std::string statFieldsOf(pid_t process);

/// True if `process` descends from this process now, within 64 generations, according to /proc. False for
/// this process itself.
bool isDescendant(pid_t process);

/// Returns the children of this process, including zombies, from the kernel's own list for this process. That
/// list is a single file, and also has children that a search of /proc may miss. For a process without
/// threads. Empty if the kernel has no such list.
std::vector<pid_t> findChildren();

/// Sends SIGKILL to this child, which has not been waited for, and to its process group if it leads one.
void killChild(pid_t child);

/// Sends SIGKILL to all descendants, and to the process group of `leader`, until none is left, for at most
/// 20 seconds. For a process without threads that is a child subreaper (PR_SET_CHILD_SUBREAPER): it becomes
/// the parent of each descendant whose own parent has ended, whatever its group or session, so none can
/// escape by forking. `leader`: a child that has not been waited for; 0: none. Returns the leader's status,
/// or SIGKILL if that is not available.
int killDescendants(pid_t leader);

/// Like killDescendants(), but spares these children and their descendants. Returns false if others are left
/// after 250 searches, which take at least half a second; then the caller must end all descendants.
bool killOthers(const std::set<pid_t>& kept);

}  // namespace naiad
