// The network's counters in a host's log.
#pragma once

#include "host/net/NetworkThread.h"
#include "host/program/LineLog.h"

namespace naiad {

/// Log what was refused or dropped before it reached a session, in up to three lines. After the network's
/// stop().
void logRefusals(const NetworkThread& network, const LogLine& log);

}  // namespace naiad
