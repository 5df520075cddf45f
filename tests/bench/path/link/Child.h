// Starts a program in a network.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "Namespace.h"

namespace bench::path {

/// Run `command` in `network` in a session of its own. With a `log`, that file is its stdout and stderr, and
/// it has no stdin. Throws std::runtime_error if it cannot be forked; a program that cannot be run ends with
/// 127.
pid_t startIn(const NetworkNamespace& network, const std::vector<std::string>& command,
              const std::string& log);

}  // namespace bench::path
