// Which processes there are below this one.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bench::attack {

/// Those of this name (/proc/PID/comm) among the children of this process, their children, and so on. Zombies
/// are none.
std::vector<pid_t> descendantsNamed(const std::string& name);

}  // namespace bench::attack
