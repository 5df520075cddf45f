// One method in one case at one number of sub-steps: how far off, and how long it took.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "Method.h"
#include "Problem.h"

namespace lab {

/// CPU time of this thread per tick of the scene, in microseconds.
struct CpuTime {
  double median = 0;
  double least = 0;
  double most = 0;
  double worst = 0;  ///< the dearest tick, the first one too: of all runs of each tick the cheapest
  double worst_part = std::numeric_limits<double>::quiet_NaN();  ///< the largest part of what a tick may cost
  double first_part = std::numeric_limits<double>::quiet_NaN();  ///< the first tick, in median ticks
};

struct Measurement {
  bool expressed = true;       ///< false: the method has no way to say this, and there is nothing else here
  std::vector<double> errors;  ///< one per metric; infinite where the run failed
  CpuTime cpu;                 ///< NaN if it crashed
  std::string reason;          ///< why it failed; empty if it did not
};

/// Errors alone, without a clock.
Measurement judge(const Case& its_case, const Method& method, int substeps);

/// Judges once, then times `runs` runs of the case's scene, which nobody watches.
Measurement measure(const Case& its_case, const Method& method, int substeps, int runs);

/// The same in a process of its own, so that a method that crashes or takes longer than `most_seconds` of CPU
/// time is a failed measurement and no more.
Measurement measureApart(const Case& its_case, const Method& method, int substeps, int runs,
                         int most_seconds);

}  // namespace lab
