// A server that is killed while clients play: its next start goes on with the round, and each of them is back
// as the same player. deploy/bench recovery does it a thousand times.
#include <gtest/gtest.h>

#include <random>

#include "RecoveryRun.h"

namespace naiad::test {
namespace {

class Recovery : public testing::TestWithParam<const char*> {};

TEST_P(Recovery, AServerThatIsKilledLosesNobodyAndNothing) {
  constexpr int kKills = 5;
  std::mt19937_64 random(7);
  RecoveryRun run(GetParam(), 2, random());
  for (int i = 0; i < kKills; ++i) {
    run.play(std::chrono::milliseconds(100 + random() % 900));
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
    EXPECT_EQ(result.ticks_lost, 0u) << i;
    EXPECT_GT(result.cells, 0u) << i;
    EXPECT_EQ(result.wrong_cells, 0u) << i << " of " << result.cells;
    if (HasFailure()) return;
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
}

INSTANTIATE_TEST_SUITE_P(Games, Recovery, testing::Values("saucershoot", "breakout", "platformer", "tron"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace naiad::test
