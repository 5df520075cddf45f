// What the product must reach, as far as no clock is needed to see it: the targets of the problems are the
// bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "Measurement.h"
#include "Records.h"

namespace lab {

namespace {

std::vector<std::string> problemIds() {
  std::vector<std::string> ids;
  for (const ProblemEntry& entry : allProblems()) ids.push_back(entry.id);
  return ids;
}

class Verdicts : public testing::TestWithParam<std::string> {};

// Targets that the product is known to miss: how far it is from them today, so that it gets no farther. What
// is met after all goes from this list.
struct Miss {
  const char* level;
  const char* metric;
  double most;
};
constexpr std::array<Miss, 0> kMisses = {};

const Miss* findMiss(const std::string& level, const std::string& metric) {
  const auto* found = std::find_if(kMisses.begin(), kMisses.end(), [&](const Miss& miss) {
    return level == miss.level && metric == miss.metric;
  });
  return found == kMisses.end() ? nullptr : found;
}

// Thousands of bodies for long.
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
    const std::string name = metricName(its_case, metric);
    const Miss* p_miss = findMiss(level.name, name);
    EXPECT_LE(judged.errors[i], p_miss == nullptr ? target : p_miss->most)
        << level.name << ' ' << name << ' ' << judged.reason;
    if (p_miss == nullptr) continue;
    EXPECT_GT(judged.errors[i], target) << level.name << ' ' << name << " is met";
  }
}

TEST_P(Verdicts, EachLevelReachesItsTargets) {
  for (const ProblemEntry& entry : allProblems()) {
    if (entry.id != GetParam()) continue;
    const Problem problem = entry.make();
    if (problem.kind != Problem::Kind::DIAGRAM) GTEST_SKIP() << "nothing is asked";
    for (const Case& its_case : problem.cases) {
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
