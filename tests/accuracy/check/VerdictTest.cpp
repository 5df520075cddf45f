// Checks the product's targets that do not depend on a clock. The limits are the targets of the problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "Measurement.h"
#include "Records.h"

namespace lab {
namespace {

std::vector<std::string> problemIds() {
  std::vector<std::string> ids;
  for (const Problem& problem : Problem::all()) ids.push_back(problem.id);
  return ids;
}

class Verdicts : public testing::TestWithParam<std::string> {};

// True for long runs of thousands of bodies, which need NAIAD_LONG_TESTS.
bool takesLong(const Case& its_case) {
  return its_case.is_crowd && its_case.long_run && std::getenv("NAIAD_LONG_TESTS") == nullptr;
}

bool isAskedOf(const Method& method, const Case& its_case) {
  return std::any_of(its_case.metrics.begin(), its_case.metrics.end(),
                     [&](const Metric& metric) { return metric.targetOf(method) >= 0; });
}

void expectTargets(const Method& level, const Case& its_case) {
  if (!isAskedOf(level, its_case) || takesLong(its_case)) return;
  const Measurement judged = judge(its_case, level, level.own_substeps);
  ASSERT_TRUE(judged.expressed) << its_case.name;
  for (std::size_t i = 0; i < its_case.metrics.size(); ++i) {
    const Metric& metric = its_case.metrics[i];
    const double target = metric.targetOf(level);
    if (target < 0) continue;
    EXPECT_LE(judged.errors[i], target)
        << level.name << ' ' << metricName(its_case, metric) << ' ' << judged.reason;
  }
}

TEST_P(Verdicts, EachLevelReachesItsTargets) {
  for (const Problem& problem : Problem::all()) {
    if (problem.id != GetParam()) continue;
    if (problem.kind != Problem::Kind::DIAGRAM) GTEST_SKIP() << "nothing is asked";
    for (const Case& its_case : problem.make()) {
      for (const Method* method : Method::all()) {
        if (method->isProduct()) expectTargets(*method, its_case);
      }
    }
  }
}

std::string nameOf(const testing::TestParamInfo<std::string>& info) {
  std::string name = "Problem" + info.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Verdicts, testing::ValuesIn(problemIds()), nameOf);

}  // namespace
}  // namespace lab
