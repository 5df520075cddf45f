// Checks that the options of a host are valid together.
#pragma once

#include <string>

#include "host/settings/HostOptions.h"

namespace naiad {

/// Returns one sentence about the first problem of the options; empty if they are valid.
std::string validateHostOptions(const HostOptions& options);

/// Prints on stderr why a server with these options would not start: the game, address, key, certificate,
/// password hashes, files, folders and sockets. Returns dfserver's exit code for the first problem; 0 without
/// problems. Creates nothing, and ignores whether ports and sockets are in use: a server may be running.
int reportDeploymentProblems(const HostOptions& options);

}  // namespace naiad
