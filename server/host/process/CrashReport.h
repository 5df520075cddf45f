// What a crash of this process leaves: a line with signal, tick and handler, and the end of the game's log.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace df {
class World;
}

namespace naiad::crash {

/// While it lives, a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) writes a line to stderr and, if that
/// is another file, to `log`, the last lines of the game's log and where to read on, and then has the effect
/// that it has without this: core dumps and exit status are those of the signal. A signal that is handled
/// already (by a sanitizer, by the game) is left alone. The thread that makes it may overflow its stack. One
/// at a time.
class Report {
 public:
  /// `name`: of the program. `log`: a descriptor; below 0: none.
  Report(const std::string& name, int log);
  /// From now on the line goes to stderr alone.
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
};

/// Crashes happen in ticks of this world from now on, until clearWorld(). Of worlds that several threads tick
/// at a time the first one is reported. Both on the thread that ticks this world.
void setWorld(df::World& world);
void clearWorld(df::World& world);

/// ", while Ship handles EventStep" (`verb`: "handles"), at this moment; empty if no handler runs. Any
/// thread.
std::string activity(std::string_view verb);

/// Is a tick running? And " in tick 17, while Ship handled EventStep". On the thread that ticks.
bool inTick();
std::string where();

/// This tick begins; 0: one has ended. On the thread that ticks.
void noteTick(std::uint64_t number);

}  // namespace naiad::crash
