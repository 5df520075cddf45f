// The cost of a journal for the thread that ticks.
#pragma once

namespace bench {

/// Returns the nanoseconds per tick that a journal adds to a Round with this many players, each with nine
/// keys a second. Includes hashing an answer of typical size, but not the world.
double journalNanos(int players);

}  // namespace bench
