// What the product must reach, as far as no clock is needed to see it: the targets of the problems are the
// bounds.
#include <gtest/gtest.h>

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

TEST_P(Verdicts, TheDefaultReachesItsTargets) {
  const Method& product = *Method::all().front();
  ASSERT_EQ(product.kind, Method::Kind::PRODUCT);
  for (const ProblemEntry& entry : allProblems()) {
    if (entry.id != GetParam()) continue;
    const Problem problem = entry.make();
    if (problem.kind != Problem::Kind::DIAGRAM) GTEST_SKIP() << "nothing is asked";
    for (const Case& its_case : problem.cases) {
      const Measurement judged = judge(its_case, product, product.own_substeps);
      EXPECT_TRUE(judged.expressed) << its_case.name;
      if (!judged.expressed) continue;
      for (std::size_t i = 0; i < its_case.metrics.size(); ++i) {
        const Metric& metric = its_case.metrics[i];
        if (metric.target < 0) continue;
        EXPECT_LE(judged.errors[i], metric.target) << metricName(its_case, metric) << ' ' << judged.reason;
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
