#include "Problem.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace lab {

namespace {

std::vector<ProblemEntry>& registry() {
  static std::vector<ProblemEntry> s_problems;
  return s_problems;
}

// Numbers first, by value, then what follows them; words last.
std::tuple<bool, long, std::string> order(const std::string& id) {
  char* rest = nullptr;
  const long number = std::strtol(id.c_str(), &rest, 10);
  return {rest == id.c_str(), number, rest};
}

}  // namespace

std::vector<ProblemEntry> allProblems() {
  std::vector<ProblemEntry> problems = registry();
  std::sort(problems.begin(), problems.end(),
            [](const ProblemEntry& a, const ProblemEntry& b) { return order(a.id) < order(b.id); });
  return problems;
}

RegisteredProblem::RegisteredProblem(const std::string& id, const std::string& name,
                                     std::function<Problem()> make) {
  registry().push_back({id, name, [id, name, make = std::move(make)] {
                          Problem problem = make();
                          problem.id = id;
                          problem.name = name;
                          return problem;
                        }});
}

}  // namespace lab
