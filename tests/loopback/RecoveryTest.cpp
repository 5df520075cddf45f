// A server is killed while clients play. Its next start resumes the round, and all clients return as the
// players that they were. `deploy/bench recovery` does this a thousand times.
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>

#include "RecoveryRun.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

class KilledServer : public testing::TestWithParam<const char*> {};

TEST_P(KilledServer, LosesNoPlayersAndNoTicks) {
  std::mt19937_64 random(7);
  RecoveryRun run(GetParam(), 2, random());
  for (int i = 0; i < (kSanitized ? 2 : 5); ++i) {
    run.play(std::chrono::milliseconds(100 + random() % 900));
    ASSERT_TRUE(run.playUntilPictured()) << i;
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
    EXPECT_EQ(result.ticks_lost, 0u) << i << ": " << result.problem;
    EXPECT_GT(result.cells, 0u) << i;
    EXPECT_EQ(result.wrong_cells, 0u) << i << " of " << result.cells << ": " << result.problem;
    RecordProperty("took_ms_" + std::to_string(i), static_cast<int>(result.took.count()));
    if (HasFailure()) return;
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
}

// The long form is `deploy/bench recovery`, with a hundred kills.
TEST(Recovery, ScoresSurviveKillsAndMatchTheRound) {
  RecoveryRun run(kScoresModule, 2, 11);
  for (int i = 0; i < 2; ++i) {
    run.play(std::chrono::milliseconds(400));
    ASSERT_TRUE(run.playUntilPictured()) << i;
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
  }
  run.play(std::chrono::milliseconds(300));
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
  const ScoreCheck check = run.checkScores();
  EXPECT_GT(check.kept, 0u) << run.log();
  EXPECT_EQ(check.missing, 0u) << "none is lost";
  EXPECT_EQ(check.foreign, 0u) << "none is there that the round does not add, or twice";
}

// Also the launcher, which starts all worlds.
TEST(Recovery, RoundContinuesAfterAllChildrenAreKilled) {
  RecoveryRun run("saucershoot", 2, 5);
  for (const bool reversed : {false, true}) {
    run.play(std::chrono::milliseconds(700));
    ASSERT_TRUE(run.killChildren(reversed)) << run.serverLog();
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
  EXPECT_TRUE(has(run.log(), "game recovered: a new world replayed"));
}

INSTANTIATE_TEST_SUITE_P(Games, KilledServer,
                         testing::Values("saucershoot", "breakout", "platformer", "tron"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace naiad::test
