// dfreplay --until T --debug: the round up to tick T, and then a debugger.
//
// The world is a process with its recorded addresses, clock and random numbers. It has executed the turns
// before T and is stopped (SIGSTOP); turn T waits in its socket. gdb is attached to it. After `continue` it
// executes turn T as it did in the round, including the keys and clicks that were dropped afterwards because
// the world crashed or hung. If it survives, it gets the turns after T, too.
#pragma once

#include <cstdint>
#include <iosfwd>

#include "server/replay/RecordedRound.h"

namespace naiad {

/// Debugs a round until the debugger ends; without gdb, until the world or the file ends, or the user ends it
/// (SIGINT, SIGTERM, SIGHUP). `out` gets messages for the user. Throws std::system_error, or RoundError if
/// the game does not run, the round has no tick `until`, its world ends before it or cannot be stopped, or
/// gdb fails.
void debugRound(const RecordedRound& round, const ReplayEnvironment& environment, std::uint32_t until,
                std::ostream& out);

}  // namespace naiad
