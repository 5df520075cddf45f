// What happened in the islands of a JointSolver, since it was made.
#pragma once

#include <cstdint>

namespace naiad::physics {

struct JointCounters {
  std::uint64_t stages = 0;
  std::uint64_t iterations = 0;   ///< of Newton, all stages together
  std::uint64_t refined = 0;      ///< steps repeated with shorter stages because one had not converged
  std::uint64_t halved = 0;       ///< stages done in two halves, where that did not help
  std::uint64_t regularised = 0;  ///< the fall-back: bounded, not exact
  std::uint64_t dependent = 0;    ///< rows that others imply, each time a matrix was factored
  std::uint64_t unsettled = 0;    ///< active sets that did not settle
  std::uint64_t quarantined = 0;  ///< islands frozen because their numbers are out of range
  std::uint64_t broken = 0;       ///< joints
};

}  // namespace naiad::physics
