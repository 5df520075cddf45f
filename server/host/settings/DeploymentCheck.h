// Checks that what the options of dfserver name outside of them exists and can be used.
#pragma once

#include <string>
#include <vector>

#include "host/settings/HostOptions.h"

namespace naiad {

struct DeploymentProblem {
  int exit_code = 0;  ///< exit code of dfserver
  std::string text;
};

/// Returns the problems because of which a server with these options would not start: game, address, key,
/// certificate, password hashes, files, folders and sockets. Creates nothing, and does not look whether a port
/// or socket is in use, so it may be called beside a running server.
std::vector<DeploymentProblem> deploymentProblems(const HostOptions& options);

/// Prints the problems on stderr. Returns the exit code of the first one; 0 if there is none.
int reportDeploymentProblems(const HostOptions& options);

}  // namespace naiad
