// A server that is killed while clients play: its next start goes on with the round, and each of them is back
// as the same player. deploy/bench recovery does it a thousand times.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "RecoveryRun.h"
#include "host/journal/DfrWriter.h"
#include "host/program/Journals.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/WholePicture.h"

namespace naiad::test {
namespace {

/// Applies snapshots of one tick each: the numbers, and which of them are complete.
class WholePictureTest : public testing::Test {
 protected:
  bool addSnapshot(std::uint32_t number, bool complete) {
    acks.addReceived(number);
    SnapshotHeader header;
    header.number = number;
    header.tick = 100 + number;
    header.complete = complete;
    picture.addSnapshot(header, acks);
    return picture.isWhole();
  }
  WholePicture picture;
  AckWindow acks;
};

TEST_F(WholePictureTest, NeedsACompleteSnapshotAndAllBeforeIt) {
  EXPECT_FALSE(picture.isWhole());
  EXPECT_FALSE(addSnapshot(1, false));
  EXPECT_TRUE(addSnapshot(2, true));
  EXPECT_FALSE(addSnapshot(4, true)) << "what was in 3 is not there";
  EXPECT_TRUE(addSnapshot(3, false)) << "now it is, and 4 is complete";
}

TEST_F(WholePictureTest, ALateSnapshotDoesNotTakeThePictureBack) {
  addSnapshot(1, true);
  addSnapshot(5, true);
  EXPECT_FALSE(addSnapshot(3, true));
  EXPECT_EQ(picture.tick(), 105u);
}

TEST_F(WholePictureTest, IsNotWholeBeforeTheFirstSnapshotsHaveCome) {
  EXPECT_FALSE(addSnapshot(2, true)) << "the world was in 1, on the stream";
  EXPECT_TRUE(addSnapshot(1, false));
}

TEST_F(WholePictureTest, LacksWhatIsMissingForAsLongAsItCanBeUnderWay) {
  addSnapshot(1, true);
  for (std::uint32_t number = 3; number <= 66; ++number) EXPECT_FALSE(addSnapshot(number, true)) << number;
  EXPECT_TRUE(addSnapshot(67, true)) << "by then what was in 2 was sent again";
}

class KilledServer : public testing::TestWithParam<const char*> {};

TEST_P(KilledServer, AServerThatIsKilledLosesNobodyAndNothing) {
  constexpr int kKills = kSanitized ? 2 : 5;
  std::mt19937_64 random(7);
  RecoveryRun run(GetParam(), 2, random());
  for (int i = 0; i < kKills; ++i) {
    run.play(std::chrono::milliseconds(100 + random() % 900));
    ASSERT_TRUE(run.playUntilPictured()) << i;
    const KillResult result = run.kill();
    EXPECT_EQ(result.returned, result.players) << i << ": " << result.problem;
    EXPECT_EQ(result.ticks_lost, 0u) << i << ": " << result.problem;
    EXPECT_GT(result.cells, 0u) << i;
    EXPECT_EQ(result.wrong_cells, 0u) << i << " of " << result.cells << ": " << result.problem;
    if (HasFailure()) return;
  }
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
}

TEST(Recovery, AWorldThatIsKilledGoesOnUnderItsPlayers) {
  RecoveryRun run("saucershoot", 2, 3);
  for (int i = 0; i < 3; ++i) {
    run.play(std::chrono::milliseconds(700));
    ASSERT_TRUE(run.killWorld()) << i << ": " << run.log();
  }
  run.play(std::chrono::milliseconds(300));
  std::string said;
  EXPECT_TRUE(run.verify(said)) << said << run.log();
}

TEST(Recovery, ARoundThatKillsServersIsGivenUp) {
  RecoveryRun run("hello", 1, 3);
  run.play(std::chrono::milliseconds(500));
  run.killServer();
  std::ofstream(run.round(), std::ios::binary | std::ios::app)
      << spellDfrMeta({{kFactAttempts, "3 1000000"}});
  EXPECT_EQ(run.comeBack().returned, 0);
  std::string said;
  run.verify(said);
  EXPECT_NE(run.log().find("has ended 3 servers that went on with it"), std::string::npos) << run.log();
}

TEST(Recovery, OfAnotherGameDoesNotHappen) {
  RecoveryRun run("hello", 1, 3);
  run.play(std::chrono::milliseconds(500));
  run.killServer();
  run.setGame("maze");
  run.comeBack();
  std::string said;
  run.verify(said);
  EXPECT_EQ(run.log().find("the round goes on"), std::string::npos) << run.log();
}

INSTANTIATE_TEST_SUITE_P(Games, KilledServer,
                         testing::Values("saucershoot", "breakout", "platformer", "tron"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace naiad::test
