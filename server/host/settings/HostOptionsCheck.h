// Do options go together, and mean something?
#pragma once

#include <string>

#include "host/settings/HostOptions.h"

namespace naiad {

/// What is wrong with options together; empty if nothing is.
std::string optionsComplaint(const HostOptions& options);

}  // namespace naiad
