#include "DisplayManager.h"
#include "EventStep.h"
#include "GameTest.h"
#include "HighScores.h"
#include "engine/world/WorldExtras.h"
#include "tests/server/engine/Probe.h"

namespace df {
namespace {

class HighScoresTest : public test::WorldTest {
 protected:
  void keep(const std::string& table, const std::string& name, std::int64_t points) {
    world.input().push(
        {.kind = InputQueue::kScore, .player = 0, .name = name, .table = table, .points = points});
  }
  std::vector<AddedScore> taken() { return world.extras().scores.popAdded(); }

  HighScores scores{"arcade"};
};

TEST_F(HighScoresTest, BestScoresComeFirstThenOldest) {
  EXPECT_TRUE(scores.best().empty());
  EXPECT_EQ(scores.add("ann", 5), 0);
  EXPECT_EQ(scores.add("bob", 7), 0);
  EXPECT_EQ(scores.add("eve", 5), 0);
  EXPECT_EQ(scores.best(), (std::vector<HighScore>{{"bob", 7}, {"ann", 5}, {"eve", 5}}));
  EXPECT_EQ(scores.best(1), (std::vector<HighScore>{{"bob", 7}}));
  EXPECT_TRUE(scores.best(0).empty());
  EXPECT_TRUE(scores.best(-1).empty());
  EXPECT_TRUE(HighScores("other").best().empty());
}

TEST_F(HighScoresTest, StoredScoresLoadFirstAndAreNotAddedAgain) {
  std::vector<std::size_t> sizes;  // of the table in each step
  test::Probe watcher;
  watcher.hear(STEP_EVENT, [&](test::Probe&, const Event&) { sizes.push_back(scores.best().size()); });
  keep("arcade", "ann", 5);
  keep("arcade", "bob", 6);
  world.tick();
  EXPECT_EQ(sizes, std::vector<std::size_t>{2});
  EXPECT_TRUE(taken().empty());
}

TEST_F(HighScoresTest, HostGetsAddedScoresOnceInOrder) {
  scores.add("ann", 5);  // before the first tick, as main() does
  world.tick();
  auto added = taken();
  ASSERT_EQ(added.size(), 1u);
  EXPECT_EQ(added[0].table, "arcade");
  EXPECT_EQ(added[0].score, (HighScore{"ann", 5}));
  EXPECT_TRUE(taken().empty());
  scores.add("bob", 1);
  scores.add("ann", 9);
  world.tick();
  added = taken();
  ASSERT_EQ(added.size(), 2u);
  EXPECT_EQ(added[0].score.name, "bob");
  EXPECT_EQ(added[1].score.name, "ann");
  EXPECT_EQ(added[0].tick, 1u) << "after the first";
  EXPECT_EQ(added[0].number, 0);
  EXPECT_EQ(added[1].number, 1);
}

TEST_F(HighScoresTest, WithoutAHostScoresDoNotPileUp) {
  for (int t = 0; t < 100; ++t) {
    for (int i = 0; i < 16; ++i) ASSERT_EQ(scores.add("ann", t), 0);
    world.tick();
  }
  EXPECT_EQ(taken().size(), HighScores::kMaxAddedInTick) << "the last tick's";
  EXPECT_EQ(scores.best(1000).size(), HighScores::kMaxRows);
  EXPECT_EQ(scores.best(1000).back().points, 93);
}

TEST_F(HighScoresTest, OnlySixteenScoresAreAcceptedPerTick) {
  for (int i = 0; i < 16; ++i) EXPECT_EQ(scores.add("ann", i), 0);
  EXPECT_EQ(HighScores("other").add("ann", 99), -1);
  EXPECT_EQ(lines.size(), 1u);
  EXPECT_EQ(world.log().refusals(), 1u);
  world.tick();
  EXPECT_EQ(scores.add("ann", 99), 0);
  EXPECT_EQ(taken().size(), 17u);
}

TEST_F(HighScoresTest, InvalidTablesNamesAndPointsAreRefused) {
  for (const std::string table : {"", "a b", "a/b", "\xc3\xa4", "123456789012345678901234567890123"}) {
    EXPECT_EQ(HighScores(table).add("ann", 1), -1) << table;
    EXPECT_TRUE(HighScores(table).best().empty());
  }
  EXPECT_EQ(scores.add("", 1), -1);
  EXPECT_EQ(scores.add("ann", HighScores::kMaxPoints + 1), -1);
  EXPECT_EQ(scores.add("ann", -HighScores::kMaxPoints - 1), -1);
  EXPECT_EQ(scores.add("ann", HighScores::kMaxPoints), 0);
  EXPECT_EQ(HighScores("12345678901234567890123456789012").add("ann", 1), 0);
  EXPECT_EQ(scores.best().size(), 1u);
}

TEST_F(HighScoresTest, ASeventeenthTableIsRefused) {
  for (int i = 0; i < 16; ++i) keep("t" + std::to_string(i), "ann", i);
  keep("t16", "ann", 16);
  EXPECT_TRUE(HighScores("t16").best().empty());
  EXPECT_EQ(HighScores("t16").add("ann", 1), -1);
  EXPECT_EQ(HighScores("t15").add("ann", 1), 0);
}

TEST_F(HighScoresTest, NamesAreTruncatedAndMadeDrawable) {
  scores.add("12345678901234567", 2);
  scores.add("a\nb\x1b[2J", 1);
  EXPECT_EQ(scores.best(), (std::vector<HighScore>{{"1234567890123456", 2}, {"a?b?[2J", 1}}));
}

TEST_F(HighScoresTest, RestartedGameKeepsItsTables) {
  scores.add("ann", 5);
  world.shutDown();
  EXPECT_EQ(scores.best(), (std::vector<HighScore>{{"ann", 5}}));
}

int watchingMain();

TEST(HighScoresInGameTest, GameTestAddsAndReadsStoredScores) {
  GameTest game(watchingMain);
  game.addStoredScore("arcade", "old", 500);
  game.join("ann");
  EXPECT_TRUE(game.shows("best old 500")) << game.picture();
  HighScores("arcade").add("ann", 501);
  game.tick();
  EXPECT_TRUE(game.shows("best ann 501")) << game.picture();
}

int watchingMain() {
  GM.startUp();
  (new test::Probe("sign", nullptr, Vector(10, 10)))->on_draw = [](test::Probe& sign) {
    for (const HighScore& best : HighScores("arcade").best(1))
      DM.drawString(sign.getPosition(), "best " + best.name + " " + std::to_string(best.points),
                    LEFT_JUSTIFIED, RED);
  };
  GM.run();
  GM.shutDown();
  return 0;
}

}  // namespace
}  // namespace df
