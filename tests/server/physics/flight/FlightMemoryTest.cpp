#include <gtest/gtest.h>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightSpring.h"
#include "tests/server/physics/ElasticField.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

TEST(Flight, AllocatesNothing) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  const ElasticField soft(10, 0.1, 1, {0, 1}), stiff(1e10, 1e5, 1, {0, 1});
  IntegratorCounters counters;
  Flown flown;
  bool is_done = true;
  const auto before = naiad::test::allocationsSoFar();
  flown = flySpring({1, 2}, {3, 4}, {0, 1}, {1e6, 10}, 1);
  flown = flySpring({}, flown.velocity, {0, 1}, {0, 0.3}, 1);
  is_done &= flyQuadraticDrag({1, 2}, {0, 1}, 0.1, 1, flown, counters) == IntegratorStatus::kDone;
  for (int method = 0; method <= static_cast<int>(IntegratorMethod::kRadau); ++method) {
    IntegratorOptions options;
    options.method = static_cast<IntegratorMethod>(method);
    is_done &= flyField(soft, {1, 0.5}, {}, 0, 1, options, flown, counters) == IntegratorStatus::kDone;
  }
  is_done &= flyField(stiff, {1, 0}, {}, 0, 0.1, {}, flown, counters) == IntegratorStatus::kDone;
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
  EXPECT_TRUE(is_done);
  EXPECT_GT(counters.stiff_calls, 0);
}

}  // namespace
}  // namespace naiad::physics
