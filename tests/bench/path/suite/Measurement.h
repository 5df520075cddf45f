// One measurement of the suite `path`: a program on a link, with several seeds.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bench::path {

/// Conditions of the link.
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

/// The median over all seeds, for each figure that the judge reports, by its key.
using Figures = std::map<std::string, double>;

/// Returns why this machine does not allow measurements; nullopt if it does.
std::optional<std::string> notAllowedBecause();
/// True if dfserver listens on addresses other than loopback addresses. Otherwise the link joins two loopback
/// addresses, and its traffic is not encrypted.
bool servesOthers();
/// Measures all seeds at once. Throws std::runtime_error if a run failed.
Figures measure(const std::string& program, const Condition& condition, const Effort& effort);

}  // namespace bench::path
