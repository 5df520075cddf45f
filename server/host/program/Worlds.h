// When a game gets worlds in processes of their own, and what starts them.
#pragma once

#include "host/program/Host.h"
#include "host/program/HostOptions.h"

namespace naiad {

/// Another round, or another world beside the first, is another process.
bool wantsWorlds(const HostOptions& options);
/// Does a key that ends the game end it for its player alone?
bool leavesAlone(const HostOptions& options);
/// For Host::setWorlds(): each is this program, started again.
Host::NewWorld startWorlds();

}  // namespace naiad
