// Where measurements go: a line each on stdout, and the files from which the report is drawn.
#pragma once

#include <cstdio>
#include <string>

#include "Measurement.h"

namespace lab {

/// The metric's name with its case: `amplitude_5hz`.
std::string metricName(const Case& its_case, const Metric& metric);

class Records {
 public:
  /// Writes `points.csv` and `problems.json` in `directory`, which is made. Throws std::runtime_error if it
  /// cannot. Empty: lines only. `runs`: how often each point is timed, if it is not as usual.
  explicit Records(const std::string& directory, int runs = 0);
  ~Records();
  Records(const Records&) = delete;
  Records& operator=(const Records&) = delete;

  /// What the report says about the problem and its cases.
  void describe(const Problem& problem);
  /// All metrics of one measurement.
  void add(const Problem& problem, const Case& its_case, const Method& method, int substeps,
           const Measurement& measurement);

  /// How many times as long as the bound's 1 it took: lines for the product and its candidates.
  void add(const Problem& problem, const Case& its_case, const CpuBound& bound, const Method& method,
           int substeps, const Measurement& measurement, double part);

  /// Has the product met every target that it was judged by?
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
