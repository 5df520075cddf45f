// One measurement of the suite `path`: a program on a link, several times with different seeds.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bench::path {

/// The link.
struct Condition {
  double rtt_ms = 0;
  double loss_percent = 0;
  double rate_kbit_s = 0;  ///< 0: no limit
  bool operator==(const Condition&) const = default;
};

struct Effort {
  double warm_up_s = 5;
  double measure_s = 60;
  int seeds = 5;
};

/// Median over the seeds of whatever the judge reports.
using Figures = std::map<std::string, double>;

/// Why this machine allows no measurement; nothing if it does.
std::optional<std::string> notAllowedBecause();
/// Does dfserver listen on addresses that are not loopback ones? Where it does not, the link joins two
/// loopback addresses instead, and what it carries is not encrypted.
bool servesOthers();
/// Measure; all seeds at the same time. Throws std::runtime_error if a run failed.
Figures measure(const std::string& program, const Condition& condition, const Effort& effort);

}  // namespace bench::path
