// Writes measurements: each as a line on stdout, and all into the files from which the report is made.
#pragma once

#include <cstdio>
#include <string>

#include "Measurement.h"

namespace lab {

/// Returns the metric's name with its case, for example `amplitude_5hz`.
std::string metricName(const Case& its_case, const Metric& metric);

class Records {
 public:
  /// Writes `points.csv` and `problems.json` into `directory`, which is created; if it is "", writes only
  /// lines. Throws std::runtime_error on failure. `runs` is the number of timed runs of each point; 0: the
  /// default.
  explicit Records(const std::string& directory, int runs = 0);
  ~Records();
  Records(const Records&) = delete;
  Records& operator=(const Records&) = delete;

  /// Writes the report's facts about the problem and its cases.
  void describe(const Problem& problem, const std::vector<Case>& cases);
  /// Adds all metrics of one measurement.
  void add(const Problem& problem, const Case& its_case, const Method& method, int substeps,
           const Measurement& measurement);

  /// Adds `part`, a time in units of the bound. Prints a line for it if the method is the product or a
  /// candidate.
  void add(const Problem& problem, const Case& its_case, const CpuBound& bound, const Method& method,
           int substeps, const Measurement& measurement, double part);

  /// True if the product has met all targets by which it was judged.
  bool allMet() const { return m_all_met; }

 private:
  void describe(const char* key, const std::string& value);
  void describe(const Case& its_case, const Metric& metric);
  void add(const Problem& problem, const Case& its_case, const Metric& metric, const Method& method,
           int substeps, double error, const Measurement& measurement);

  std::FILE* m_points = nullptr;
  std::FILE* m_problems = nullptr;
  bool m_first = true;
  bool m_all_met = true;
};

}  // namespace lab
