// Reports a crash of this process: a line with signal, tick and handler, and the end of the game's log.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace df {
class World;
}

namespace naiad::crash {

/// While this exists, a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) writes a line to stderr and, if that
/// is another file, to `log`, the last lines of the game's log, and a hint. Then the signal has its usual
/// effect, with core dump and exit status. Signals that already have a handler (of a sanitizer or the game)
/// are left alone. The thread that makes it may overflow its stack. One at a time.
class Report {
 public:
  /// `name`: the program's. `log`: a descriptor; below 0: none.
  Report(const std::string& name, int log);
  /// Later crashes are written to stderr alone.
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
};

/// Sets the world whose ticks crash reports describe, until clearWorld(). If several threads tick worlds, the
/// first world is described. Call both on the thread that ticks this world.
void setWorld(df::World& world);
void clearWorld(df::World& world);

/// Returns ", while Ship handles EventStep" (`verb`: "handles") at this moment; empty if no handler runs. Any
/// thread.
std::string activity(std::string_view verb);

/// inTick() is true if a tick is running, and where() is " in tick 17, while Ship handled EventStep". Both on
/// the thread that ticks.
bool inTick();
std::string where();

/// Call when tick `number` begins, and with 0 when one has ended, on the thread that ticks.
void setTick(std::uint64_t number);

}  // namespace naiad::crash
