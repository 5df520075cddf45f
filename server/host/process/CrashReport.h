// Reports a crash of this process: a line with signal, tick and handler, and the end of the game's log.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace df {
class World;
}

namespace naiad::crash {

/// After this is made, a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) is reported on stderr and, if that
/// is another file, in `log`: one line, the last lines of the game's log, and a hint. Then the signal has its
/// usual effect, with core dump and exit status. Signals that already have a handler (of a sanitizer or the
/// game) are left alone. A stack overflow is reported only on a thread that makes a Report. A further
/// Report replaces name and log.
class Report {
 public:
  /// `name`: the program's name. `log`: a descriptor; below 0: none.
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

/// Returns ", while Ship handles EventStep" (`verb`: "handles") now; empty if no handler runs. Any thread.
std::string activity(std::string_view verb);

/// inTick() is true if a tick is running; where() returns " in tick 17, while Ship handled EventStep". Call
/// both on the thread that ticks.
bool inTick();
std::string where();

/// Call on the thread that ticks: with its number when a tick begins, and with 0 when it has ended.
void setTick(std::uint64_t number);

}  // namespace naiad::crash
