// dfreplay --until T --debug: the round up to tick T, and then a debugger.
//
// The world is a process with the addresses, clock and random numbers that it had. It has executed the turns
// before T and is stopped (SIGSTOP); turn T waits in its socket. gdb is attached to it, and from `continue`
// on it executes turn T as it did then: with the keys and clicks that were left out of the round afterwards,
// because the world died by them. If it lives, it gets the turns after T, too.
#pragma once

#include <cstdint>
#include <iosfwd>

#include "server/replay/RecordedRound.h"

namespace naiad {

/// Until the debugger ends; without gdb, until the world or the user (SIGINT, SIGTERM) ends it. `out` gets
/// sentences for the user. Throws RoundError if the round has no tick `until`, or its world does not come so
/// far or cannot be stopped; std::system_error.
void debugRound(const RecordedRound& round, const RoundStage& stage, std::uint32_t until, std::ostream& out);

}  // namespace naiad
