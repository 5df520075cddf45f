// Checks that the options of a host are valid together.
#pragma once

#include <string>

#include "host/settings/HostOptions.h"

namespace naiad {

/// Returns one sentence about the first problem of the options; empty if they are valid.
std::string validateHostOptions(const HostOptions& options);

}  // namespace naiad
