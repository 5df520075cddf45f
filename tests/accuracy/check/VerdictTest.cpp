// Checks the product's targets that do not depend on a clock. The limits are the targets of the problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
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

struct Miss {
  const char *problem, *metric, *level;
  double ceiling;  ///< limit of the error until the target is reached
};

// Targets that the product misses. Remove a line when its target is met.
constexpr Miss kMisses[] = {
    {"25", "overlap_m_heap2000", "fast", .14},  // the limit on energy costs .03
    {"26", "sinking_m_60", "default", .47},
};

const Miss* missOf(const std::string& problem, const std::string& metric, const Method& level) {
  const Miss* const p_end = std::end(kMisses);
  const Miss* const p_miss = std::find_if(std::begin(kMisses), p_end, [&](const Miss& miss) {
    return problem == miss.problem && metric == miss.metric && level.name == miss.level;
  });
  return p_miss == p_end ? nullptr : p_miss;
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

void expectTargets(const std::string& problem, const Method& level, const Case& its_case) {
  if (!isAskedOf(level, its_case) || takesLong(its_case)) return;
  const Measurement judged = judge(its_case, level, level.own_substeps);
  ASSERT_TRUE(judged.expressed) << its_case.name;
  for (std::size_t i = 0; i < its_case.metrics.size(); ++i) {
    const Metric& metric = its_case.metrics[i];
    const double target = metric.targetOf(level);
    if (target < 0) continue;
    const std::string name = metricName(its_case, metric);
    const Miss* const p_miss = missOf(problem, name, level);
    if (p_miss != nullptr) {
      EXPECT_GT(judged.errors[i], target) << name << " is met now";
    }
    EXPECT_LE(judged.errors[i], p_miss == nullptr ? target : p_miss->ceiling)
        << level.name << ' ' << name << ' ' << judged.reason;
  }
}

TEST_P(Verdicts, EachLevelReachesItsTargets) {
  for (const Problem& problem : Problem::all()) {
    if (problem.id != GetParam()) continue;
    if (problem.kind != Problem::Kind::DIAGRAM) GTEST_SKIP() << "nothing is asked";
    for (const Case& its_case : problem.make()) {
      for (const Method* method : Method::all()) {
        if (method->isProduct()) expectTargets(problem.id, *method, its_case);
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
