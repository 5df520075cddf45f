// The line that a crash of this process leaves: signal, tick, and what the game was handling.
#pragma once

#include <cstdint>
#include <string>

namespace df {
class World;
}

namespace naiad::crash {

/// While it lives, a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) writes one line to stderr and, if that
/// is another file, to `log`, and then has the effect that it has without this: core dumps and exit status
/// are those of the signal. A signal that is handled already (by a sanitizer, by the game) is left alone. The
/// thread that makes it may overflow its stack. One at a time.
class Report {
 public:
  /// `name`: of the program. `log`: a descriptor; below 0: none.
  Report(const std::string& name, int log);
  /// From now on the line goes to stderr alone.
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
};

/// Crashes happen in ticks of this world from now on; null: of none.
void setWorld(const df::World* p_world);

/// This tick begins; 0: one has ended. On the thread that ticks.
void noteTick(std::uint64_t number);

}  // namespace naiad::crash
