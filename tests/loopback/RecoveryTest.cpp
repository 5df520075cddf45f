// A server is killed while clients play. Its next start resumes the round, and all clients return as the
// players that they were. `deploy/bench recovery` does this a thousand times.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "RecoveryRun.h"
#include "host/journal/DfrWriter.h"
#include "host/rounds/RoundJournals.h"
#include "tests/support/Processes.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

class KilledServer : public testing::TestWithParam<const char*> {
 protected:
  /// Interrupts a round, each time after a random time of at most `until`.
  static void expectNothingLost(int times, KillResult (RecoveryRun::*p_interrupt)(), unsigned until) {
    std::mt19937_64 random(7);
    RecoveryRun run(GetParam(), 2, random());
    for (int i = 0; i < times; ++i) {
      run.play(std::chrono::milliseconds(100 + random() % until));
      ASSERT_TRUE(run.playUntilPictured()) << i;
      const KillResult result = (run.*p_interrupt)();
      EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
      EXPECT_EQ(result.ticks_lost, 0u) << i << ": " << result.problem;
      EXPECT_GT(result.cells, 0u) << i;
      EXPECT_EQ(result.wrong_cells, 0u) << i << " of " << result.cells << ": " << result.problem;
      RecordProperty("took_ms_" + std::to_string(i), static_cast<int>(result.took.count()));
      RecordProperty("pause_ms_" + std::to_string(i), static_cast<int>(result.pause.count()));
      if (HasFailure()) return;
    }
    std::string said;
    EXPECT_TRUE(run.verify(said)) << said << run.log();
  }
};

TEST_P(KilledServer, LosesNoPlayersAndNoTicks) {
  expectNothingLost(kSanitized ? 2 : 5, &RecoveryRun::kill, 900);
}

// After dfctl restart --keep, players and ticks are kept like after a kill.
TEST_P(KilledServer, KeepRestartLosesNoPlayersAndNoTicks) {
  expectNothingLost(std::getenv("NAIAD_LONG_TESTS") != nullptr ? 5 : 1, &RecoveryRun::keepRound, 400);
}

// Simulates a machine that was off for longer than the grace time. The world still uses the ids of the lost
// players.
TEST(Recovery, NewPlayersSeeTheRecoveredRoundWithoutItsPlayers) {
  constexpr std::chrono::hours kDay{24};
  RecoveryRun run("saucershoot", 2, 13);
  run.play(std::chrono::milliseconds(300));
  for (const auto& [away, newcomers] :
       {std::pair<std::chrono::seconds, int>{kDay, 1}, {std::chrono::minutes(5), 3}, {kDay, 2}}) {
    ASSERT_TRUE(run.playUntilPictured());
    EXPECT_EQ(run.replacePlayers(away, newcomers), newcomers) << away.count() << " s later: " << run.log();
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

TEST(Recovery, KilledWorldResumesFromACheckpoint) {
  RecoveryRun run("saucershoot", 2, 3);
  for (int i = 0; i < 3; ++i) {
    run.play(std::chrono::milliseconds(700));
    const auto took = run.killWorld();
    ASSERT_TRUE(took) << i << ": " << run.log();
    RecordProperty("next_picture_ms_" + std::to_string(i), static_cast<int>(took->count()));
    EXPECT_LT(*took, std::chrono::seconds(10)) << i;
  }
  // The players saw correct pictures of the world that took over.
  run.play(std::chrono::milliseconds(300));
  ASSERT_TRUE(run.playUntilPictured());
  const std::vector<pid_t> copies = run.copies();
  EXPECT_FALSE(copies.empty());
  const KillResult result = run.kill();
  EXPECT_EQ(result.returned, result.players) << result.problem;
  EXPECT_EQ(result.ticks_lost, 0u) << result.problem;
  EXPECT_GT(result.cells, 0u);
  EXPECT_EQ(result.wrong_cells, 0u) << result.problem;
  for (const pid_t copy : copies) EXPECT_TRUE(isGone(copy)) << "it waits for a server that was killed";
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
  EXPECT_TRUE(has(run.log(), "game recovered: a copy of its world replayed"));
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

TEST(Recovery, RoundThatKillsServersIsAbandoned) {
  RecoveryRun run("hello", 1, 3);
  run.play(std::chrono::milliseconds(500));
  run.killServer();
  std::ofstream(run.round(), std::ios::binary | std::ios::app)
      << encodeDfrMeta({{kFactAttempts, "3 1000000"}});
  EXPECT_EQ(run.comeBack().returned, 0);
  std::string said;
  run.verify(said);
  EXPECT_TRUE(has(run.log(), "after 3 failed recoveries"));
}

INSTANTIATE_TEST_SUITE_P(Games, KilledServer,
                         testing::Values("saucershoot", "breakout", "platformer", "tron"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace naiad::test
