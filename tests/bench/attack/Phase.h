// A server of its own, honest players, and an attack or none, for some time.
#pragma once

#include <chrono>
#include <string>

#include "Attack.h"
#include "Company.h"

namespace bench::attack {

struct PhaseResult {
  Fate fate;
  double seconds = 0;
  double ticks = -1;       ///< of the server; -1: it ended without a last line
  double late_ticks = -1;  ///< of these, begun more than 5 ms late
  double cpu_percent = 0;  ///< of one core that the server took in the second half
  bool died = false;       ///< the server ended by itself
};

/// `attack`: whose server it is. It attacks if `hostile`. Throws std::runtime_error if nothing could be
/// measured.
PhaseResult runPhase(Attack& attack, bool hostile, std::chrono::seconds duration);

}  // namespace bench::attack
