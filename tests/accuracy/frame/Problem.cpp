#include "Problem.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace lab {
namespace {

std::vector<Problem>& registry() {
  static std::vector<Problem> s_problems;
  return s_problems;
}

// Returns a sort key: ids that begin with a number come first, by its value and then by their suffix, words
// last.
std::tuple<bool, long, std::string> order(const std::string& id) {
  char* rest = nullptr;
  const long number = std::strtol(id.c_str(), &rest, 10);
  return {rest == id.c_str(), number, rest};
}

std::string labelOf(const std::string& method) {
  for (const Method* other : Method::all()) {
    if (other->name == method) return other->label;
  }
  return method;
}

std::string timeOf(const CpuBound& bound) {
  if (!bound.unit_label.empty()) return bound.unit_label;
  if (bound.is_of_later) return "a later tick";
  return labelOf(bound.method) + " at ×" + std::to_string(bound.substeps);
}

}  // namespace

Metric CpuBound::metric() const {
  const std::string what = is_of_later ? "time of the first tick" : "time per tick";
  return {name, what + " ÷ that of " + timeOf(*this), target, 0, fast_target};
}

double TickBound::allowedUs(double bodies, double contacts, double joints, double impacts) const {
  return base_us + each_us * (bodies + contacts + joints) + impact_us * std::min(impacts, most_impacts);
}

Metric Case::worstTick() {
  return {"worst_tick", "dearest tick ÷ what it may cost", 1, 0, 1};
}

std::vector<Problem> Problem::all() {
  std::vector<Problem> problems = registry();
  std::sort(problems.begin(), problems.end(),
            [](const Problem& a, const Problem& b) { return order(a.id) < order(b.id); });
  return problems;
}

RegisteredProblem::RegisteredProblem(const std::string& id, const std::string& name,
                                     std::vector<Case> (*make)(), const std::string& title,
                                     const std::string& why, Problem::Kind kind) {
  registry().push_back({id, name, make, title, why, kind});
}

}  // namespace lab
