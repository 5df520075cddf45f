// Measures one method in one case at one number of sub-steps: its errors and its run time.
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
  double worst = 0;  ///< slowest tick, including the first; the time of each is its minimum over all runs
  double worst_part = std::numeric_limits<double>::quiet_NaN();  ///< largest tick time relative to its limit
  double first_part = std::numeric_limits<double>::quiet_NaN();  ///< first tick relative to the median
};

struct Measurement {
  bool expressed = true;       ///< false: the method cannot express the scene, and the rest is unset
  std::vector<double> errors;  ///< one per metric; infinite where the run failed
  CpuTime cpu;                 ///< NaN if it crashed or was not timed
  std::string reason;          ///< reason of a failure, or empty
};

/// Computes only errors, without timing.
Measurement judge(const Case& its_case, const Method& method, int substeps);

/// Computes the errors in one run, then times `runs` further runs of the case's scene without computing
/// errors, unless the method is not timed. All of this is done in its own process, so that a crash or more
/// than `most_seconds` of CPU time is only a failed measurement.
Measurement measureApart(const Case& its_case, const Method& method, int substeps, int runs,
                         int most_seconds);

}  // namespace lab
