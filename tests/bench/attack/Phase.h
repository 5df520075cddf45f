// Runs a server with honest players for some time, with or without an attack.
#pragma once

#include <chrono>
#include <string>

#include "Attack.h"
#include "Company.h"

namespace bench::attack {

struct PhaseResult {
  Fate fate;
  double seconds = 0;
  double ticks = -1;       ///< number of the server's ticks; -1: it ended without its last log line
  double late_ticks = -1;  ///< ticks that began more than 5 ms late
  double cpu_percent = 0;  ///< the server's share of one core in the second half
  bool died = false;       ///< the server ended by itself
};

/// Runs a phase with the server that `attack` needs. Attacks only if `hostile`. Throws std::runtime_error if
/// nothing could be measured.
PhaseResult runPhase(Attack& attack, bool hostile, std::chrono::seconds duration);

}  // namespace bench::attack
