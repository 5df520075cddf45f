// What a journal costs the thread that ticks.
#pragma once

namespace bench {

/// Nanoseconds of a tick that a journal adds to a Round, with so many players who press nine keys a second
/// each: with hashing an answer of a usual size, without the world.
double journalNanos(int players);

}  // namespace bench
